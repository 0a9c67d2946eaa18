# The `spillway` command: a library of subcommands and a short main.
add_library(spillway_command STATIC
  batch.cpp
  check.cpp
  child_process.cpp
  command.cpp
  command_options.cpp
  completion.cpp
  contour.cpp
  convert.cpp
  convert_meshes.cpp
  convert_points.cpp
  core_simulation.cpp
  dem.cpp
  dem_options.cpp
  facet_count.cpp
  failure.cpp
  generate.cpp
  info.cpp
  input_list.cpp
  input_options.cpp
  interrupts.cpp
  job_list.cpp
  job_log.cpp
  job_record.cpp
  job_steps.cpp
  json_text.cpp
  lattice_rounding.cpp
  manual.cpp
  option_tree.cpp
  output_check.cpp
  point_comparison.cpp
  point_output.cpp
  printable_text.cpp
  progress.cpp
  progress_line.cpp
  relief_scene.cpp
  render.cpp
  space_scene.cpp
  standard_descriptors.cpp
  standard_error.cpp
  terrain_input.cpp
  text_output.cpp
  rank_job.cpp
  rank_statistics.cpp
  statistics.cpp
  suggestion.cpp
  triangulate.cpp
  triangulation_options.cpp)
target_compile_definitions(spillway_command PRIVATE SPILLWAY_VERSION="${PROJECT_VERSION}")
target_link_libraries(spillway_command
  PUBLIC spillway_stream nlohmann_json::nlohmann_json CLI11::CLI11
  PRIVATE spillway_generators spillway_checker fmt::fmt)

add_executable(spillway main.cpp)
target_link_libraries(spillway PRIVATE spillway_command)

# The man page and the shell completions come out of the command itself.
set(SPILLWAY_MANUAL ${CMAKE_CURRENT_BINARY_DIR}/spillway.1)
set(SPILLWAY_COMPLETIONS ${CMAKE_CURRENT_BINARY_DIR}/completion)
file(MAKE_DIRECTORY ${SPILLWAY_COMPLETIONS})
add_custom_command(
  OUTPUT ${SPILLWAY_MANUAL} ${SPILLWAY_COMPLETIONS}/spillway.bash
         ${SPILLWAY_COMPLETIONS}/_spillway ${SPILLWAY_COMPLETIONS}/spillway.fish
  COMMAND spillway manual > ${SPILLWAY_MANUAL}
  COMMAND spillway completion bash > ${SPILLWAY_COMPLETIONS}/spillway.bash
  COMMAND spillway completion zsh > ${SPILLWAY_COMPLETIONS}/_spillway
  COMMAND spillway completion fish > ${SPILLWAY_COMPLETIONS}/spillway.fish
  DEPENDS spillway VERBATIM)
add_custom_target(spillway_manual ALL DEPENDS ${SPILLWAY_MANUAL})

include(GNUInstallDirs)
install(TARGETS spillway RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${SPILLWAY_MANUAL} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${SPILLWAY_COMPLETIONS}/spillway.bash RENAME spillway
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${SPILLWAY_COMPLETIONS}/_spillway
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${SPILLWAY_COMPLETIONS}/spillway.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
