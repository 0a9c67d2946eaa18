spillway_test(stream_unit_test unit
  SOURCES stream/output/heights_test.cpp stream/output/unpaired_facets_test.cpp
          stream/output/sequencer_test.cpp stream/plan/memory_plan_test.cpp
          stream/sinks/band_store_test.cpp stream/sinks/contour_shape_test.cpp stream/sinks/contour_shares_test.cpp
          stream/sinks/contour_test.cpp
          stream/sinks/line_joiner_test.cpp stream/sinks/pixel_points_test.cpp stream/sinks/raster_store_test.cpp
          stream/sinks/tetrahedron_writers_test.cpp
          stream/points/equal_points_test.cpp stream/tiles/storage/cell_sketch_test.cpp stream/points/point_buffer_test.cpp stream/points/point_sample_test.cpp
          stream/points/point_span_test.cpp stream/tiles/storage/segment_reader_test.cpp
          stream/points/encoded_points_test.cpp stream/tiles/cuts/tile_cut_test.cpp
          stream/tiles/tile_node_test.cpp stream/tiles/storage/parted_points_test.cpp stream/tiles/storage/tile_points_test.cpp stream/tiles/storage/tile_segment_test.cpp
          stream/tiles/tile_sketches_test.cpp stream/tiles/tile_tree_test.cpp stream/tiles/cuts/cut_lookup_test.cpp
          stream/tiles/cuts/cut_tree_test.cpp stream/tiles/cuts/dealt_points_test.cpp
          stream/tiles/cuts/sample_division_test.cpp stream/tiles/cuts/sample_mesh_test.cpp
          stream/tiles/regions/reading_order_test.cpp stream/tiles/regions/region_plan_test.cpp
          stream/run_phases_test.cpp
          stream/triangulate/border_growth_test.cpp stream/triangulate/border_test.cpp
          stream/triangulate/leaf_border_test.cpp
          stream/triangulate/cell_tree_test.cpp stream/triangulate/merge_forest_test.cpp stream/triangulate/merge_tree_test.cpp
          stream/triangulate/nodes_before_test.cpp
          stream/triangulate/sample_forecast_test.cpp stream/triangulate/settle_test.cpp
          stream/triangulate/surroundings_test.cpp stream/triangulate/task_sums_test.cpp
          stream/triangulate/tile_engine_test.cpp
          stream/triangulate/tile_triangulation_test.cpp
          stream/triangulate/work_lanes_test.cpp
  LIBS spillway_stream)

spillway_test(stream_property_test property
  SOURCES stream/early_triangulation_test.cpp stream/stream_property_test.cpp
  LIBS spillway_stream spillway_generators cgal_oracle
  TIMEOUT 900)

spillway_test(stream_nd_test property
  SOURCES stream/higher_dimensions_test.cpp
  LIBS spillway_stream spillway_generators cgal_oracle_nd
  TIMEOUT 600)

spillway_test(stream_fault_test fault
  SOURCES stream/stream_fault_test.cpp
  LIBS spillway_stream spillway_generators)

spillway_test(point_input_test unit
  SOURCES stream/source/changed_input_test.cpp stream/source/common_lattice_test.cpp
          stream/source/condition_test.cpp
          stream/source/header_survey_test.cpp
          stream/source/input_crs_test.cpp stream/source/input_regions_test.cpp
          stream/source/ordered_blocks_test.cpp stream/source/piece_sequence_test.cpp
          stream/source/point_filter_test.cpp stream/source/thinning/point_runs_test.cpp
          stream/source/joined_inputs_test.cpp stream/source/source_coordinates_test.cpp
          stream/source/source_crs_test.cpp stream/source/source_facts_test.cpp stream/source/thinning/thinning_test.cpp
  LIBS spillway_stream fmt::fmt)

spillway_test(dem_test property
  SOURCES stream/sinks/dem_test.cpp stream/sinks/dem_neighbours_test.cpp stream/sinks/dem_oracle_test.cpp
          stream/sinks/dem_points_test.cpp
          stream/sinks/dem_sheets_test.cpp
  LIBS spillway_stream_ranks
  TIMEOUT 300)

spillway_mpi_test(rank_pipeline_test
  SOURCES stream/ranks/rank_pipeline_test.cpp
  LIBS spillway_stream_ranks spillway_generators
  RANKS 1 2 3 4 5 8
  TIMEOUT 600)

# A driver for many random sets; see the head of its source.
if(SPILLWAY_MPI)
  add_executable(rank_sweep EXCLUDE_FROM_ALL stream/ranks/rank_sweep.cpp)
  target_link_libraries(rank_sweep PRIVATE
    spillway_stream_ranks spillway_generators CLI11::CLI11 GTest::gmock test_build)
endif()

spillway_test(rank_messages_test unit
  SOURCES stream/ranks/exchange/messages_test.cpp
          stream/ranks/part_file_numbers_test.cpp stream/ranks/merges/owned_vertices_test.cpp
  LIBS spillway_stream_ranks)

spillway_mpi_test(rank_unit_test
  SOURCES stream/ranks/part_files_test.cpp stream/ranks/exchange/piece_table_test.cpp
          stream/ranks/exchange/point_exchange_test.cpp stream/ranks/rank_tree_test.cpp
          stream/ranks/exchange/rank_division_test.cpp stream/ranks/shared_report_test.cpp
          stream/ranks/rank_executor_test.cpp stream/ranks/share_messages_test.cpp
          stream/ranks/mesh_attributes_over_ranks_test.cpp stream/ranks/stream_sections_test.cpp
          stream/ranks/exchange/collective_step_test.cpp stream/ranks/rank_checkpoints_test.cpp
  LIBS spillway_stream_ranks
  RANKS 1 2 3 5
  TIMEOUT 300)

spillway_mpi_test(rank_output_test
  SOURCES stream/ranks/rank_output_test.cpp
  LIBS spillway_stream_ranks
  RANKS 1 2 3 5
  TIMEOUT 300)

spillway_test(stream_library_test unit
  SOURCES stream/library/attribute_table_test.cpp stream/library/attributes_test.cpp
          stream/library/convert_points_test.cpp stream/library/generate_grid_test.cpp
          stream/library/generate_test.cpp stream/library/misuse_test.cpp
          stream/library/passed_on_test.cpp stream/library/runs_beside_test.cpp
          stream/library/higher_dimensions_test.cpp
          stream/library/sort_points_test.cpp stream/library/triangulate_test.cpp
          stream/library/products/check_test.cpp stream/library/products/height_test.cpp
          stream/library/products/info_test.cpp
          stream/library/products/point_comparison_test.cpp stream/library/products/product_test.cpp
          stream/library/products/products_test.cpp stream/library/tiling/mesh_tiles_test.cpp
          stream/library/tiling/raster_tiling_test.cpp
          stream/library/products/volume_test.cpp
  LIBS spillway_stream spillway_library)

spillway_test(stream_ground_test unit
  SOURCES stream/ground/ground_heights_test.cpp stream/ground/tile_index_test.cpp
  LIBS spillway_stream)

spillway_test(stream_library_unit_test unit
  SOURCES stream/library/context/context_state_test.cpp stream/library/context/run_watch_test.cpp
          stream/library/meshes/engine_sink_test.cpp stream/library/meshes/mesh_file_test.cpp
          stream/library/meshes/opened_mesh_test.cpp stream/library/meshes/program_mesh_test.cpp
          stream/library/meshes/program_sink_test.cpp stream/library/meshes/public_values_test.cpp
          stream/library/meshes/whole_mesh_test.cpp
          stream/library/points/attribute_columns_test.cpp
          stream/library/points/attribute_records_test.cpp
          stream/library/points/generated_points_test.cpp
          stream/library/points/grid_names_test.cpp
          stream/library/points/lattice_rounding_test.cpp
          stream/library/points/lost_fields_test.cpp stream/library/points/point_file_test.cpp
          stream/library/points/program_points_test.cpp
          stream/library/points/public_points_test.cpp
  LIBS spillway_stream)

spillway_test(periodic_test property
  SOURCES stream/periodic/periodic_triangulation_test.cpp stream/checker/torus_proof_test.cpp
  LIBS spillway_stream spillway_library)

spillway_test(density_test property
  SOURCES stream/density/density_test.cpp
  LIBS spillway_stream spillway_library)
