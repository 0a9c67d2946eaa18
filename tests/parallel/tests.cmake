spillway_test(parallel_test unit
  SOURCES parallel/parallel_test.cpp parallel/thread_demand_test.cpp
  LIBS spillway_parallel)
