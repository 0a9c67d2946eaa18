# GDAL stands in a module that is loaded when first needed, so that other runs pay nothing for it.
# Whatever uses the formats needs the module when it runs, so it is built with them.
include(GNUInstallDirs)
add_library(spillway_gdal MODULE
  gdal/crs.cpp
  gdal/gdal_errors.cpp
  gdal/geotiff.cpp
  gdal/module.cpp
  gdal/ogr_layer.cpp
  gdal/ogr_triangles.cpp)
target_link_libraries(spillway_gdal PRIVATE spillway_build PkgConfig::gdal fmt::fmt)
set_target_properties(spillway_gdal PROPERTIES
  PREFIX "" CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
install(TARGETS spillway_gdal LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/spillway)

target_sources(spillway_formats PRIVATE gdal/load.cpp raster_file.cpp)
set_source_files_properties(gdal/load.cpp PROPERTIES COMPILE_DEFINITIONS
  SPILLWAY_LIBRARY_FOLDER="${CMAKE_INSTALL_LIBDIR}")
target_link_libraries(spillway_formats PRIVATE ${CMAKE_DL_LIBS})
add_dependencies(spillway_formats spillway_gdal)
