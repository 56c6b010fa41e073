# stress, first-miss and auto: their parts, and the commands end to end.
portcullis_test(bench_stress SOURCES test_stress.c LIBS portcullis_bench)
target_compile_definitions(test_bench_stress PRIVATE "TWO_ROOMS=\"${CMAKE_CURRENT_SOURCE_DIR}/two_rooms.json\"")
portcullis_test(bench_auto SOURCES test_auto.c LIBS portcullis_bench)
portcullis_bench_test(bench_first_miss_command ${CMAKE_CURRENT_SOURCE_DIR}/test_first_miss.sh $<TARGET_FILE:portcullis> ${PROJECT_BINARY_DIR}/mutants
  ${CMAKE_CURRENT_SOURCE_DIR}/two_rooms.json ${PROJECT_SOURCE_DIR}/scenes/cellar.json)
portcullis_bench_test(bench_stress_command ${CMAKE_CURRENT_SOURCE_DIR}/test_stress.sh $<TARGET_FILE:portcullis> ${PROJECT_BINARY_DIR}/test_plugins_bench
  ${CMAKE_CURRENT_SOURCE_DIR}/two_rooms.json ${PROJECT_SOURCE_DIR}/scenes/cellar.json)
portcullis_bench_test(bench_auto_command ${CMAKE_CURRENT_SOURCE_DIR}/test_auto.sh $<TARGET_FILE:portcullis> ${PROJECT_BINARY_DIR}/test_plugins_bench)
set_property(TEST bench_first_miss_command APPEND PROPERTY LABELS not_by_clang) # its broken plugins are not built there
