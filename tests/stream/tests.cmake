spillway_test(stream_unit_test unit
  SOURCES stream/output/heights_test.cpp stream/output/sequencer_test.cpp stream/plan/memory_plan_test.cpp
          stream/sinks/contour_test.cpp
          stream/tiles/cut_tree_test.cpp stream/tiles/point_span_test.cpp stream/tiles/tile_tree_test.cpp
          stream/triangulate/border_test.cpp stream/triangulate/merge_tree_test.cpp
          stream/triangulate/settle_test.cpp
  LIBS spillway_stream)

spillway_test(stream_property_test property
  SOURCES stream/stream_property_test.cpp
  LIBS spillway_stream spillway_generators cgal_oracle
  TIMEOUT 900)

spillway_test(stream_fault_test fault
  SOURCES stream/stream_fault_test.cpp
  LIBS spillway_stream spillway_generators)

spillway_test(point_input_test unit
  SOURCES stream/source/common_lattice_test.cpp stream/source/point_filter_test.cpp stream/source/point_runs_test.cpp
          stream/source/point_source_test.cpp stream/source/thinning_test.cpp
  LIBS spillway_stream fmt::fmt)

spillway_test(dem_test property
  SOURCES stream/sinks/dem_test.cpp stream/sinks/dem_oracle_test.cpp
  LIBS spillway_stream_ranks
  TIMEOUT 300)

spillway_mpi_test(rank_pipeline_test
  SOURCES stream/ranks/rank_pipeline_test.cpp
  LIBS spillway_stream_ranks spillway_generators
  RANKS 1 2 3 4 5 8
  TIMEOUT 600)

spillway_mpi_test(rank_output_test
  SOURCES stream/ranks/rank_output_test.cpp
  LIBS spillway_stream_ranks
  RANKS 1 2 3 5
  TIMEOUT 300)

spillway_test(stream_library_test unit
  SOURCES stream/library/triangulate_test.cpp
  LIBS spillway_stream spillway_library)
