# LAZ and COPC: what a chunk is made of, chunks, files.
target_sources(spillway_formats PRIVATE
  laz/arithmetic_decoder.cpp
  laz/chunk_decoder.cpp
  laz/chunk_table.cpp
  laz/copc_info.cpp
  laz/copc_octree.cpp
  laz/items_v1.cpp
  laz/items_v2.cpp
  laz/layered_chunk.cpp
  laz/laz_reader.cpp
  laz/laz_record.cpp
  laz/models.cpp
  laz/piece_input.cpp
  laz/point14_layers.cpp
  laz/pointwise_chunk.cpp
  laz/source_bytes.cpp)
