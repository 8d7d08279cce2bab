# SPDX-License-Identifier: Apache-2.0
# Part of the installation: what is written then, below `share`, by `program` or from files of `source`.
# Days are those of SOURCE_DATE_EPOCH, where it is set.
find_program(gzip gzip REQUIRED)
function(written file)
  execute_process(COMMAND ${program} ${ARGN} OUTPUT_FILE ${share}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(zipped file)
  execute_process(COMMAND ${gzip} -9nf ${share}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(folder man/man1 bash-completion/completions zsh/vendor-completions fish/vendor_completions.d doc/cei3d
    lintian/overrides)
  file(MAKE_DIRECTORY ${share}/${folder})
endforeach()
written(man/man1/cei3d.1 manual)
zipped(man/man1/cei3d.1)
written(bash-completion/completions/cei3d completion bash)
written(zsh/vendor-completions/_cei3d completion zsh)
written(fish/vendor_completions.d/cei3d.fish completion fish)

file(COPY_FILE ${source}/tools/package/copyright ${share}/doc/cei3d/copyright)
file(COPY_FILE ${source}/tools/package/lintian-overrides ${share}/lintian/overrides/cei3d)
file(COPY_FILE ${source}/CHANGELOG.md ${share}/doc/cei3d/changelog)
zipped(doc/cei3d/changelog)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${share}/doc/cei3d/changelog.Debian "cei3d (${version}-1) unstable; urgency=medium

  * Package of version ${version}; what changed: changelog.gz.

 -- CEI-3D maintainers <maintainers@cei3d.invalid>  ${date}
")
zipped(doc/cei3d/changelog.Debian)
