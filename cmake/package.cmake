# SPDX-License-Identifier: Apache-2.0
# What is installed (`cmake --install`), and the .deb that CPack makes of it. The program itself writes its manual page
# and completions, when they are installed. tools/package.sh calls this.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
  WORLD_EXECUTE)
set(package_folder ${CMAKE_SOURCE_DIR}/tools/package)

install(TARGETS cei3d RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY samples/spot DESTINATION ${CMAKE_INSTALL_DATADIR}/cei3d/samples FILE_PERMISSIONS OWNER_READ OWNER_WRITE
  GROUP_READ WORLD_READ)
install(CODE "
  set(program $<TARGET_FILE:cei3d>)
  set(version ${PROJECT_VERSION})
  set(source ${CMAKE_SOURCE_DIR})
  set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  include(${package_folder}/written_files.cmake)")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cei3d)
set(CPACK_PACKAGE_CONTACT "CEI-3D maintainers <maintainers@cei3d.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "editable, relightable 3D objects from photographs")
set(CPACK_PACKAGE_DESCRIPTION "CEI-3D reconstructs an object from posed photographs as a 3D object that
can be edited and relit. Surface, albedo, material and light are estimated
separately, so that paint on one photograph is seen from every view, a part
can be recolored or removed, the shape dragged, the light changed, and a
textured model exported.
.
`cei3d demo` shows all of it on a sample capture in a few minutes.")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
