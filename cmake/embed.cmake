# SPDX-License-Identifier: Apache-2.0
# The files of src/web as a C++ source: cmake -D SOURCE_DIR=src/web -D OUT=x.cpp -P embed.cmake. Besides every file as it
# is, the modules of the page that `export` writes, joined into one script: browsers load no module from a file:// page.
# Joining leaves out imports and the word `export`, so top-level names must differ between these modules.
set(modules pack camera orbit controls shaders targets renderer page)  # each after those that it imports

function(embed name content)
  if(content MATCHES "\\)page\"")
    message(FATAL_ERROR "${name}: )page\" ends a C++ string")
  endif()
  string(SHA256 hash "${content}")
  file(APPEND ${OUT}.new "{\"${name}\", R\"page(${content})page\", \"${hash}\"},\n")
endfunction()

file(WRITE ${OUT}.new "// Made by cmake/embed.cmake.\n#include \"engine/page/page_files.h\"\n\nnamespace cei3d {\nnamespace {\n\n"
  "constexpr PageFile kFiles[] = {\n")
file(GLOB files RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/*.js ${SOURCE_DIR}/*.css ${SOURCE_DIR}/*.html)
foreach(file ${files})
  file(READ ${SOURCE_DIR}/${file} content)
  embed(${file} "${content}")
endforeach()
set(script "")
foreach(module ${modules})
  file(READ ${SOURCE_DIR}/${module}.js content)
  string(REGEX REPLACE "(^|\n)import {[^}]*} from '[^']*';" "" content "${content}")
  string(REGEX REPLACE "\nexport " "\n" content "${content}")
  string(APPEND script "${content}")
endforeach()
if(script MATCHES "</script")
  message(FATAL_ERROR "src/web: a script must not hold its own end")
endif()
embed("page.joined.js" "${script}")
file(APPEND ${OUT}.new "};\n\n}  // namespace\n\nstd::span<const PageFile> page_files() { return kFiles; }\n\n}  // namespace cei3d\n")
file(RENAME ${OUT}.new ${OUT})
