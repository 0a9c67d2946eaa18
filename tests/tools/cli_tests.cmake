# The command, run as a process, and its parts that need none.
spillway_test(command_unit_tests unit
  SOURCES tools/command_unit_test.cpp tools/options/help_layout_test.cpp
    tools/options/former_names_test.cpp tools/options/suggestion_test.cpp tools/process/program_pages_test.cpp
    tools/report/advice_test.cpp
    tools/simulate/core_simulation_test.cpp tools/simulate/machine_test.cpp
    tools/simulate/run_player_test.cpp tools/simulate/run_recorder_test.cpp
  LIBS spillway_command nlohmann_json::nlohmann_json)

add_library(command_runner STATIC tools/command_runner.cpp)
target_link_libraries(command_runner PUBLIC spillway_runtime fmt::fmt nlohmann_json::nlohmann_json
                      PRIVATE test_paths GTest::gtest)

function(spillway_command_test name label)
  spillway_test(${name} ${label} SOURCES ${ARGN} LIBS command_runner SKIPS_BY_ITSELF)
  add_dependencies(${name} spillway)
endfunction()

spillway_command_test(cli_tests cli
  tools/commands/cli_dimensions_test.cpp
  tools/commands/cli_formats_test.cpp
  tools/commands/cli_height_test.cpp
  tools/commands/cli_info_check_test.cpp
  tools/commands/cli_density_test.cpp
  tools/commands/cli_periodic_formats_test.cpp
  tools/commands/cli_shared_data_test.cpp
  tools/commands/cli_convert_copc_test.cpp tools/commands/cli_convert_laz_test.cpp
  tools/commands/cli_convert_points_test.cpp
  tools/commands/cli_convert_sorted_test.cpp
  tools/commands/cli_convert_test.cpp tools/inputs/cli_stream_test.cpp
  tools/commands/cli_triangulate_test.cpp
  tools/commands/cli_vertex_attributes_test.cpp
  tools/commands/cli_volume_test.cpp
  tools/options/cli_unused_options_test.cpp
  tools/options/cli_usage_test.cpp)
spillway_command_test(cli_fault_tests fault
  tools/process/cli_batch_signal_test.cpp
  tools/process/cli_descriptor_test.cpp
  tools/process/cli_fault_test.cpp
  tools/process/cli_limit_test.cpp
  tools/process/cli_same_output_test.cpp
  tools/process/cli_signal_test.cpp)
spillway_command_test(cli_out_of_core_tests cli
  tools/process/cli_memory_test.cpp tools/process/cli_out_of_core_test.cpp)
spillway_command_test(cli_out_of_core_fault_tests fault
  tools/process/cli_out_of_core_fault_test.cpp)
add_library(other_gdal_module MODULE tools/inputs/other_gdal_module.cpp)
set_target_properties(other_gdal_module PROPERTIES PREFIX "" OUTPUT_NAME spillway_gdal
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/other_version)
spillway_command_test(cli_input_tests cli
  tools/inputs/cli_clip_test.cpp tools/inputs/cli_crs_test.cpp tools/inputs/cli_filter_test.cpp tools/inputs/cli_inputs_test.cpp
  tools/inputs/cli_lattice_test.cpp tools/inputs/cli_salvage_test.cpp
  tools/inputs/cli_table_layout_test.cpp tools/inputs/cli_table_test.cpp tools/inputs/cli_survey_test.cpp)

spillway_command_test(cli_encoded_tests cli
  tools/inputs/cli_encoded_test.cpp)
target_link_libraries(cli_encoded_tests PRIVATE laz_encoder)

spillway_command_test(cli_progress_tests cli
  tools/report/cli_figures_test.cpp tools/report/cli_progress_test.cpp
  tools/report/progress_lines.cpp)

spillway_command_test(cli_batch_tests cli
  tools/commands/cli_batch_resume_test.cpp tools/commands/cli_batch_test.cpp
  tools/commands/cli_contour_test.cpp tools/commands/cli_vector_tiles_test.cpp)

if(SPILLWAY_GDAL)
  spillway_command_test(cli_dem_tests cli
    tools/commands/cli_batch_buffer_test.cpp
    tools/commands/cli_dem_test.cpp tools/commands/cli_dem_survey_test.cpp
    tools/commands/cli_dem_gdaldem_test.cpp tools/commands/cli_dem_points_test.cpp
    tools/commands/cli_dem_tiles_test.cpp
    tools/commands/cli_dem_units_test.cpp
    tools/commands/cli_layers_test.cpp tools/inputs/cli_raster_points_test.cpp)
  target_link_libraries(cli_dem_tests PRIVATE PkgConfig::gdal)
else()
  add_test(NAME cli_dem_tests COMMAND ${CMAKE_COMMAND} -E echo "rasters need GDAL, which this build has not")
  set_tests_properties(cli_dem_tests PROPERTIES LABELS cli SKIP_REGULAR_EXPRESSION "need GDAL, which this build")
endif()

spillway_command_test(cli_render_tests cli
  tools/commands/cli_render_colours_test.cpp tools/commands/cli_render_page_test.cpp
  tools/commands/cli_render_test.cpp)
target_link_libraries(cli_render_tests PRIVATE PNG::PNG)
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME Render.PagesInABrowser
    COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/commands/page_in_browser.py $<TARGET_FILE:spillway>)
  set_tests_properties(Render.PagesInABrowser PROPERTIES LABELS cli TIMEOUT 300 SKIP_RETURN_CODE 77)
endif()

if(SPILLWAY_MPI)
  spillway_command_test(cli_ranks_tests mpi
    tools/process/cli_ranks_test.cpp tools/report/progress_lines.cpp)
endif()

# A product that tests add to the command.
spillway_test_program(mean_slope_command
  tools/commands/mean_slope/main.cpp tools/commands/mean_slope/mean_slope.cpp)
target_link_libraries(mean_slope_command PRIVATE spillway_command nlohmann_json::nlohmann_json)
spillway_command_test(added_product_test cli tools/commands/mean_slope/product_test.cpp)
add_dependencies(added_product_test mean_slope_command)

# Two runs of the same commands make the same files and messages, and leave nothing in temporary folders.
add_test(NAME Digests.TwoRunsAreTheSame
  COMMAND ${PROJECT_SOURCE_DIR}/tests/digests.sh --twice $<TARGET_FILE:spillway>
    "^(generate-terrain|mesh-(spm|npy|gpkg)|option-(stats|json|tiles)|core-space|thin-lowest|dem-products|contour-shp|render-wireframe|info-points|check-points|convert-text|convert-to-laz|batch-several|fault-(cut|max-edge)|usage-option)$")
set_tests_properties(Digests.TwoRunsAreTheSame PROPERTIES LABELS cli TIMEOUT 300)
