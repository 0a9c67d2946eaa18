# spillway_mpi_test(NAME SOURCES file... LIBS target... RANKS number... [TIMEOUT seconds])
# One test program, run with each number of ranks as the ctest test NAME.with_N_ranks, label mpi. Its
# cases reach the ranks by world(), tests/distributed/world.h.
# Nothing in a build without MPI.
function(spillway_mpi_test name)
  if(NOT SPILLWAY_MPI)
    return()
  endif()
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBS;RANKS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  spillway_test_program(${name} ${ARG_SOURCES} distributed/mpi_main.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} spillway_ranks)
  foreach(ranks IN LISTS ARG_RANKS)
    add_test(NAME ${name}.with_${ranks}_ranks
             COMMAND ${MPIEXEC_EXECUTABLE} -n ${ranks} --oversubscribe --bind-to none
                     $<TARGET_FILE:${name}>)
    # Containers run tests as root, which mpirun refuses unless it is told twice. What Open MPI never
    # gives back, from modules that are unloaded by then, is no leak of ours.
    set_tests_properties(${name}.with_${ranks}_ranks PROPERTIES
      LABELS mpi TIMEOUT ${ARG_TIMEOUT} PROCESSORS 2
      ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;ASAN_OPTIONS=detect_leaks=0")
  endforeach()
endfunction()

spillway_mpi_test(ranks_test
  SOURCES distributed/ranks_test.cpp
  LIBS spillway_ranks
  RANKS 1 2 3 5 8)

if(NOT SPILLWAY_MPI)
  spillway_test(one_rank_test unit
    SOURCES distributed/one_rank_test.cpp
    LIBS spillway_ranks)
endif()

spillway_mpi_test(distributed_delaunay_test
  SOURCES distributed/delaunay_test.cpp
  LIBS spillway_distributed spillway_generators
  RANKS 1 2 3 4 5 8)
