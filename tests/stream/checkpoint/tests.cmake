# Runs that are killed and go on.
spillway_test(checkpoint_test unit
  SOURCES stream/checkpoint/checkpoint_folder_test.cpp formats/state/state_test.cpp formats/disk/kept_scratch_test.cpp
          stream/library/resumable_run_test.cpp
  LIBS spillway_stream)

find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(driver ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/kill_driver.py $<TARGET_FILE:spillway>)
  add_test(NAME Checkpoints.killed_runs_end_with_the_same_bytes COMMAND ${driver} --kills 4 --points 100000)
  add_test(NAME Checkpoints.damaged_states_make_no_other_mesh
    COMMAND ${driver} --damages 10 --points 50000 --family spilled --family planned --family spooled --family dem)
  add_test(NAME Checkpoints.runs_on_a_full_disk_go_on_when_there_is_room
    COMMAND ${driver} --full-disks 1 --points 50000 --family spilled --family planned --family spooled --family stl
            --family dem --family ranks)
  set_tests_properties(Checkpoints.runs_on_a_full_disk_go_on_when_there_is_room
    PROPERTIES LABELS fault TIMEOUT 300 SKIP_RETURN_CODE 77)
  set_tests_properties(Checkpoints.killed_runs_end_with_the_same_bytes Checkpoints.damaged_states_make_no_other_mesh
    PROPERTIES LABELS fault TIMEOUT 600)
endif()
