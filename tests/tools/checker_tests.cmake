spillway_test(checker_test unit
  SOURCES tools/checker_test.cpp
  LIBS spillway_checker cgal_oracle)
