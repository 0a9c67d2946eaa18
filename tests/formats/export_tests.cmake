# GDAL's module, and the mesh formats that other programs take.
spillway_test(gdal_test unit
  SOURCES formats/gdal/crs_text_test.cpp formats/gdal/gdal_test.cpp
  LIBS spillway_formats)
spillway_test(mesh_export_test unit
  SOURCES formats/meshes/mesh_export_test.cpp formats/meshes/vector/vector_mesh_test.cpp
  LIBS spillway_formats nlohmann_json::nlohmann_json)
