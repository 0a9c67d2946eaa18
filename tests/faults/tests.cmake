# Every call to the system fails in turn: a library loaded before the command makes it fail.

find_package(Python3 COMPONENTS Interpreter)
# The sanitizers have an allocator of their own, and must be loaded first.
if(Python3_FOUND AND NOT SPILLWAY_SANITIZE)
  add_library(fault_injector MODULE ${CMAKE_CURRENT_LIST_DIR}/fault_injector.cpp)
  target_link_libraries(fault_injector PRIVATE ${CMAKE_DL_LIBS})
  set_target_properties(fault_injector PROPERTIES
    CXX_VISIBILITY_PRESET default PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  set(driver ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/fault_driver.py
    $<TARGET_FILE:spillway> $<TARGET_FILE:fault_injector> --jobs 2)
  function(spillway_fault_test name)
    add_test(NAME Faults.${name} COMMAND ${driver} ${ARGN})
    set_tests_properties(Faults.${name} PROPERTIES LABELS fault TIMEOUT 300)
  endfunction()
  spillway_fault_test(EveryCallOnFiles --calls files --family
    tiled,text,space,tiles,laz,thinned,dem,contour,picture,page,checked,converted --most 12)
  spillway_fault_test(EveryCallOnScratchFiles --calls files --family spilled,spooled,sorted --most 8)
  spillway_fault_test(WhatIsReadOfFilesWithChecksums --calls input --family proved,sealed --most 8)
  spillway_fault_test(EveryCallOfRunsThatGoOn --calls files --family resumed,batch --most 12)
  if(SPILLWAY_MPI)
    spillway_fault_test(EveryCallOfRanks --calls files --family rank_0,rank_1 --most 6)
  endif()
  spillway_fault_test(EveryRequestOfMemory --calls memory --most 15)
  spillway_fault_test(EveryThread --calls thread)
endif()
