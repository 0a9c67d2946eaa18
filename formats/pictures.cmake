target_sources(spillway_formats PRIVATE png.cpp)
target_link_libraries(spillway_formats PRIVATE PNG::PNG)
