# Generated scenes, judged by a reader of their own and by the importers.
find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
portcullis_test(generate SOURCES test_generate.c obj_probe.c LIBS bench_generate host_import PkgConfig::XXHASH)
portcullis_test(generate_zones SOURCES test_generate_zones.c obj_probe.c ${PROJECT_SOURCE_DIR}/tests/common/failing_allocator.c
  ${PROJECT_SOURCE_DIR}/tests/common/report_lines.c LIBS bench_generate host_import PkgConfig::XXHASH)
portcullis_test(generate_forest SOURCES test_generate_forest.c obj_probe.c ${PROJECT_SOURCE_DIR}/tests/common/scratch_folder.c LIBS bench_generate)
