# Everything here is of the component `library`: headers, both libraries, and what finds them.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Spillway)
set(pkgconfig ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(DIRECTORY spillway DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library FILES_MATCHING PATTERN "*.h")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/spillway/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/spillway COMPONENT library)

# Apart, as only a link with the static one needs other packages.
foreach(kind shared static)
  install(TARGETS spillway_${kind} EXPORT spillway_${kind}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
  install(EXPORT spillway_${kind} NAMESPACE Spillway:: FILE spillway_${kind}.cmake
    DESTINATION ${package} COMPONENT library)
endforeach()

configure_package_config_file(SpillwayConfig.cmake.in SpillwayConfig.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/SpillwayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/SpillwayConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/SpillwayConfigVersion.cmake
  DESTINATION ${package} COMPONENT library)

# From the folder of spillway.pc to the prefix, so that the prefix can be moved.
file(RELATIVE_PATH SPILLWAY_PREFIX_FROM_PKGCONFIG
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(spillway.pc.in spillway.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/spillway.pc DESTINATION ${pkgconfig} COMPONENT library)
