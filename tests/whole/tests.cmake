# Random runs of the whole command against CGAL, and wrong meshes that `check` must refuse.
spillway_test_program(cgal_mesh whole/cgal_mesh.cpp)
target_link_libraries(cgal_mesh PRIVATE cgal_oracle cgal_oracle_nd)
