# SPILLWAY_BUNDLE: the command with what it needs but the C library, as an archive that runs from any folder.
#
# All libraries are found by the search path of the program, as it is of the old kind (RPATH), which holds for libraries
# of libraries, too, unless these have one of their own: that is removed.
if(NOT SPILLWAY_COMMAND OR NOT SPILLWAY_INSTALL)
  message(FATAL_ERROR "SPILLWAY_BUNDLE needs SPILLWAY_COMMAND and SPILLWAY_INSTALL")
endif()
set_target_properties(spillway PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
target_link_options(spillway PRIVATE -Wl,--disable-new-dtags)

find_program(PATCHELF patchelf REQUIRED)

set(bundled spillway)
if(SPILLWAY_GDAL)
  list(APPEND bundled spillway_gdal)
endif()
install(TARGETS ${bundled} RUNTIME_DEPENDENCY_SET bundle
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/spillway)
set(of_the_c_library "^lib(c|m|mvec|pthread|dl|rt|util|resolv|anl)[.]so[.]" "^ld-linux")
install(RUNTIME_DEPENDENCY_SET bundle PRE_EXCLUDE_REGEXES ${of_the_c_library}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})

# What PROJ and GDAL read: PROJ looks for it beside its library, the module tells GDAL (formats/gdal/module).
if(SPILLWAY_GDAL)
  install(FILES /usr/share/proj/proj.db /usr/share/proj/proj.ini DESTINATION share/proj)
  install(DIRECTORY /usr/share/gdal DESTINATION share PATTERN "grib2*" EXCLUDE PATTERN "*.svg" EXCLUDE
    PATTERN "*.png" EXCLUDE)
endif()

# Libraries lose search paths of their own, and the licence of each comes along under the name of its Debian package.
install(CODE "
  set(patchelf ${PATCHELF})
  set(machine ${CMAKE_LIBRARY_ARCHITECTURE})
  set(libraries_folder ${CMAKE_INSTALL_LIBDIR})
  set(licences_folder ${CMAKE_INSTALL_DOCDIR}/libraries)")
install(CODE [[
  set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
  file(GLOB libraries RELATIVE "${prefix}/${libraries_folder}" "${prefix}/${libraries_folder}/*.so*")
  set(names)
  set(places)
  foreach(name IN LISTS libraries)
    if(NOT IS_SYMLINK "${prefix}/${libraries_folder}/${name}")
      execute_process(COMMAND ${patchelf} --remove-rpath "${prefix}/${libraries_folder}/${name}"
        COMMAND_ERROR_IS_FATAL ANY)
      list(APPEND names ${name})
      list(APPEND places "/usr/lib/${name}" "*/${machine}/${name}" "*/${machine}/*/${name}")
    endif()
  endforeach()
  execute_process(COMMAND dpkg-query --search ${places} OUTPUT_VARIABLE owners ERROR_QUIET)
  foreach(name IN LISTS names)
    string(REPLACE "." "[.]" pattern "${name}")
    string(REPLACE "+" "[+]" pattern "${pattern}")
    if(NOT owners MATCHES "/${pattern}\n")
      message(FATAL_ERROR "no Debian package has ${name}, so its licence is not known")
    endif()
  endforeach()
  string(REGEX MATCHALL "[^\n]+" owners "${owners}")
  list(TRANSFORM owners REPLACE "[:,].*" "")
  list(REMOVE_DUPLICATES owners)
  file(MAKE_DIRECTORY "${prefix}/${licences_folder}")
  foreach(package IN LISTS owners)
    file(COPY_FILE "/usr/share/doc/${package}/copyright" "${prefix}/${licences_folder}/${package}")
  endforeach()
]])

cmake_host_system_information(RESULT system QUERY DISTRIB_ID DISTRIB_VERSION_ID)
list(JOIN system "" system)
set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_FILE_NAME spillway-${PROJECT_VERSION}-${system}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
