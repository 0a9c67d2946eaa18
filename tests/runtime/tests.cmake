spillway_test(runtime_test unit
  SOURCES runtime/error_test.cpp runtime/freed_memory_test.cpp runtime/memory_budget_test.cpp
          runtime/packing_test.cpp runtime/page_pool_test.cpp runtime/process_memory_test.cpp
          runtime/run_memory_test.cpp runtime/stage_times_test.cpp runtime/task_test.cpp
          runtime/work_forecast_test.cpp runtime/work_lease_test.cpp
  LIBS spillway_parallel)
