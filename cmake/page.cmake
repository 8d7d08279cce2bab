# SPDX-License-Identifier: Apache-2.0
# Puts the files of src/web into a module's library (cmake/embed.cmake).
function(cei3d_embedded_page path)
  cei3d_target_name(${path} target)
  set(out ${CMAKE_BINARY_DIR}/page_files.cpp)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/web/*.js ${CMAKE_SOURCE_DIR}/src/web/*.css
    ${CMAKE_SOURCE_DIR}/src/web/*.html)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${CMAKE_SOURCE_DIR}/src/web -D OUT=${out} -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake COMMENT "Embedding src/web" VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()
