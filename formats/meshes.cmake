# Meshes: PLY, OBJ, OFF, VTU, npy pairs.
target_sources(spillway_formats PRIVATE
  block_input.cpp
  block_output.cpp
  checked_mesh_writer.cpp
  fields.cpp
  input_kind.cpp
  mesh_checks.cpp
  mesh_notes.cpp
  mesh_reader.cpp
  mesh_text.cpp
  mesh_writer.cpp
  npy_mesh.cpp
  npy_mesh_writer.cpp
  number_type.cpp
  obj_reader.cpp
  obj_writer.cpp
  off_reader.cpp
  off_writer.cpp
  ply_header.cpp
  ply_reader.cpp
  ply_values.cpp
  ply_writer.cpp
  vtu_header.cpp
  vtu_reader.cpp
  vtu_writer.cpp
  xml_scanner.cpp)
