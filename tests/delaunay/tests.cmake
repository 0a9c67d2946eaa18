add_library(cgal_oracle STATIC delaunay/cgal_oracle.cpp)
target_link_libraries(cgal_oracle PUBLIC spillway_build spillway_headers PRIVATE CGAL::CGAL)

spillway_test(delaunay_unit_test unit
  SOURCES delaunay/base_case/affine_basis_test.cpp delaunay/base_case/base_case_test.cpp
          delaunay/border/acceptance_test.cpp delaunay/border/conflict_region_test.cpp
          delaunay/border/exposure_test.cpp delaunay/border/facing_sides_test.cpp
          delaunay/border/find_border_test.cpp delaunay/border/merge_test.cpp
          delaunay/border/point_search_test.cpp delaunay/border/conflict_region_batch_test.cpp
          delaunay/border/run_boxes_test.cpp delaunay/border/simplex_index_test.cpp
          delaunay/common/hash_test.cpp delaunay/common/schedule_test.cpp
          delaunay/common/working_memory_test.cpp
          delaunay/division/cut_judgement_test.cpp delaunay/division/cut_rule_test.cpp
          delaunay/division/divide_test.cpp
          delaunay/division/filled_share_test.cpp
          delaunay/kernel_common/hilbert_order_test.cpp delaunay/verify.cpp
  LIBS spillway_delaunay cgal_oracle)

spillway_test(delaunay_property_test property
  SOURCES delaunay/delaunay_property_test.cpp delaunay/verify.cpp
  LIBS spillway_delaunay spillway_generators cgal_oracle
  TIMEOUT 900)

add_library(kernel_sets STATIC delaunay/kernel_sets.cpp delaunay/verify.cpp)
target_link_libraries(kernel_sets PUBLIC spillway_delaunay spillway_generators
                      PRIVATE cgal_oracle fmt::fmt)

spillway_test(kernel_2d_test property
  SOURCES delaunay/kernel_2d/kernel_2d_test.cpp delaunay/kernel_2d/predicates_test.cpp
  LIBS kernel_sets
  TIMEOUT 300)

spillway_test(kernel_3d_test property
  SOURCES delaunay/kernel_3d/kernel_3d_test.cpp delaunay/kernel_3d/predicates_test.cpp
          delaunay/kernel_common/safe_box_test.cpp
  LIBS kernel_sets
  TIMEOUT 300)

find_package(Eigen3 REQUIRED NO_MODULE)
add_library(cgal_oracle_nd STATIC delaunay/cgal_oracle_nd.cpp)
target_link_libraries(cgal_oracle_nd PUBLIC spillway_build spillway_headers
                      PRIVATE CGAL::CGAL Eigen3::Eigen)

spillway_test(kernel_nd_test property
  SOURCES delaunay/kernel_nd/kernel_nd_test.cpp delaunay/verify.cpp
  LIBS spillway_delaunay cgal_oracle_nd
  TIMEOUT 300)

spillway_test(kernel_shared_data_test property
  SOURCES delaunay/kernel_shared_data_test.cpp
  LIBS kernel_sets spillway_formats fmt::fmt
  TIMEOUT 600)

# Not a test: runs as long as asked.
add_executable(kernel_driver delaunay/kernel_driver.cpp)
target_link_libraries(kernel_driver PRIVATE kernel_sets CLI11::CLI11 fmt::fmt)
