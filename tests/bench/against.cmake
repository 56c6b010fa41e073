# The culler `frustum` a fifth slower than it is, for bench/against.sh, and the tests of the rule that must notice.
# SPDX-License-Identifier: MIT
add_library(slow_frustum MODULE plugins/slow_frustum.c "$<FILTER:$<TARGET_OBJECTS:plugin_frustum>,EXCLUDE,/frustum[.]c[.]o>")
target_link_libraries(slow_frustum PRIVATE portcullis_flags portcullis_api m)
set_target_properties(slow_frustum PROPERTIES PREFIX "" OUTPUT_NAME frustum SUFFIX ".culler.so" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/slow_plugins)
portcullis_test(bench_against SOURCES test_against.c LIBS portcullis_bench)
portcullis_test(bench_shard_names SOURCES test_shard.c LIBS portcullis_bench)
portcullis_bench_test(bench_against_cli ${CMAKE_CURRENT_SOURCE_DIR}/against.sh $<TARGET_FILE:portcullis>)
