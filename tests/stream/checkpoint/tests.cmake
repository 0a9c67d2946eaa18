# Runs that are killed and go on.
spillway_test(checkpoint_test unit
  SOURCES stream/checkpoint/checkpoint_folder_test.cpp stream/checkpoint/run_identity_test.cpp
          formats/state/state_test.cpp formats/disk/kept_scratch_test.cpp
          stream/library/resumable_run_test.cpp
  LIBS spillway_stream)

find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(driver ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/kill_driver.py $<TARGET_FILE:spillway>)
  function(checkpoint_test name)
    add_test(NAME Checkpoints.${name} COMMAND ${driver} ${ARGN})
    set_tests_properties(Checkpoints.${name} PROPERTIES LABELS fault TIMEOUT 400 SKIP_RETURN_CODE 77)
  endfunction()
  checkpoint_test(killed_runs_end_with_the_same_bytes --kills 4 --points 100000 --family spilled --family planned
    --family planned_space --family space --family surface --family spooled --family text --family thinned)
  checkpoint_test(killed_products_end_with_the_same_bytes --kills 4 --points 100000 --family stl --family dem
    --family dem_planned --family contour --family batch)
  checkpoint_test(killed_ranks_end_with_the_same_bytes --kills 4 --points 60000 --family ranks --family ranks_spilled
    --family ranks_text --family ranks_space --family ranks_dem --family ranks_contour)
  checkpoint_test(damaged_states_make_no_other_mesh --damages 8 --points 50000 --family spilled --family planned
    --family spooled --family stl --family dem --family ranks)
  checkpoint_test(runs_on_a_full_disk_go_on_when_there_is_room --full-disks 1 --points 50000 --family spilled
    --family planned --family spooled --family stl --family dem --family ranks)
endif()
