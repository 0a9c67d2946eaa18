add_library(cgal_oracle STATIC delaunay/cgal_oracle.cpp)
target_link_libraries(cgal_oracle PUBLIC spillway_build PRIVATE CGAL::CGAL)

spillway_test(delaunay_unit_test unit
  SOURCES delaunay/acceptance_test.cpp delaunay/base_case_test.cpp delaunay/cut_judgement_test.cpp
          delaunay/divide_test.cpp delaunay/exposure_test.cpp delaunay/filled_share_test.cpp
          delaunay/find_border_test.cpp
          delaunay/hilbert_order_test.cpp delaunay/parallel_test.cpp delaunay/point_search_test.cpp
          delaunay/run_boxes_test.cpp delaunay/schedule_test.cpp
          delaunay/working_memory_test.cpp
  LIBS spillway_delaunay)

spillway_test(delaunay_property_test property
  SOURCES delaunay/delaunay_property_test.cpp delaunay/verify.cpp
  LIBS spillway_delaunay spillway_generators cgal_oracle
  TIMEOUT 900)

add_library(kernel_sets STATIC delaunay/kernel_sets.cpp delaunay/verify.cpp)
target_link_libraries(kernel_sets PUBLIC spillway_delaunay spillway_generators
                      PRIVATE cgal_oracle fmt::fmt)

spillway_test(kernel_2d_test property
  SOURCES delaunay/kernel_2d_test.cpp delaunay/kernel_2d_predicates_test.cpp
  LIBS kernel_sets
  TIMEOUT 300)

spillway_test(kernel_3d_test property
  SOURCES delaunay/kernel_3d_test.cpp delaunay/kernel_3d_predicates_test.cpp
          delaunay/kernel_clear_box_test.cpp
  LIBS kernel_sets
  TIMEOUT 300)

spillway_test(kernel_shared_data_test property
  SOURCES delaunay/kernel_shared_data_test.cpp
  LIBS kernel_sets spillway_formats fmt::fmt
  TIMEOUT 600)

# Not a test: runs as long as asked.
add_executable(kernel_driver delaunay/kernel_driver.cpp)
target_link_libraries(kernel_driver PRIVATE kernel_sets CLI11::CLI11 fmt::fmt)
