# SPDX-License-Identifier: Apache-2.0
# Files that become part of a library: name and bytes of all below a folder. Also run as a script, which writes the source.
if(CMAKE_SCRIPT_MODE_FILE)
  file(GLOB_RECURSE names RELATIVE ${FOLDER} ${FOLDER}/*.html ${FOLDER}/*.js ${FOLDER}/*.css ${FOLDER}/*.svg)
  list(SORT names)
  set(data "")
  set(table "")
  set(i 0)
  foreach(name ${names})
    file(READ ${FOLDER}/${name} hex HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
    string(LENGTH "${hex}" length)
    math(EXPR length "${length} / 2")
    string(APPEND data "constexpr unsigned char kFile${i}[] = {${bytes}0};\n")
    string(APPEND table "    {\"editor/${name}\", {reinterpret_cast<const char*>(kFile${i}), ${length}}},\n")
    math(EXPR i "${i} + 1")
  endforeach()
  file(WRITE ${OUT} "#include <span>\n#include \"apps/server/assets.h\"\nnamespace cei3d {\nnamespace {\n${data}const Asset kAssets[] = {\n${table}};\n}  // namespace\nstd::span<const Asset> embedded_assets();\nstd::span<const Asset> embedded_assets() { return kAssets; }\n}  // namespace cei3d\n")
  return()
endif()

# cei3d_embedded_editor(target folder): embedded_assets() of apps/server/assets.h in the target.
function(cei3d_embedded_editor target folder)
  set(out ${CMAKE_BINARY_DIR}/embedded_assets.cpp)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*.html ${folder}/*.js ${folder}/*.css ${folder}/*.svg)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DOUT=${out} -P ${CMAKE_SOURCE_DIR}/cmake/editor.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/editor.cmake COMMENT "Embedding ${folder}")
  target_sources(${target} PRIVATE ${out})
endfunction()
