# Mutants: each plugin broken at five places that it has, each able to lose a pixel. The bench must report every one.
function(portcullis_mutant plugin name file old new)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/mutants/${plugin}-${name})
  get_target_property(sources plugin_${plugin} SOURCES)
  list(TRANSFORM sources PREPEND ${folder}/ OUTPUT_VARIABLE copies)
  file(GLOB originals CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/${plugin}/*.[ch])
  string(REPLACE ${PROJECT_SOURCE_DIR}/plugins/${plugin} ${folder} all_copies "${originals}")
  add_custom_command(OUTPUT ${all_copies}
    COMMAND ${CMAKE_COMMAND} -DFROM=${PROJECT_SOURCE_DIR}/plugins/${plugin} -DTO=${folder} -DFILE=${file} "-DOLD=${old}" "-DNEW=${new}"
            -P ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake
    DEPENDS ${originals} ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake VERBATIM)
  add_library(mutant_${plugin}_${name} MODULE ${copies} ${all_copies})
  target_link_libraries(mutant_${plugin}_${name} PRIVATE portcullis_flags portcullis_api m)
  set_target_properties(mutant_${plugin}_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${plugin} SUFFIX ".culler.so"
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/mutants/${plugin}-${name})
  foreach(source ${sources}) # each file's own instruction set
    get_source_file_property(options ${PROJECT_SOURCE_DIR}/plugins/${plugin}/${source} DIRECTORY ${PROJECT_SOURCE_DIR}/plugins/${plugin} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${folder}/${source} PROPERTIES COMPILE_OPTIONS "${options}")
    endif()
  endforeach()
endfunction()

portcullis_mutant(frustum drops-one-in-1000 walk_body.h
  "& block_entries(w->index, 0, block);" "& block_entries(w->index, 0, block) & (block % 63 ? 0xffffu : 0xfffeu);")
portcullis_mutant(frustum shrinks-a-plane walk_body.h
  "p.normal.z, -p.offset," "p.normal.z, -p.offset + (k == 0 ? 0.5f : 0),")
portcullis_mutant(frustum skips-a-child walk_body.h
  "out->cut &= out->touching;" "out->touching &= 0xff7fu; out->cut &= out->touching;")
portcullis_mutant(frustum loses-the-last-run walk_body.h
  "    return run_count;" "    return run_count - (run_count > 8);")
portcullis_mutant(frustum takes-the-near-corner walk_body.h
  "p.normal.y >= 0 ? 64 : 16" "p.normal.y >= 0 ? 16 : 64")

add_test(NAME bench_reports_mutants COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/mutants.sh $<TARGET_FILE:portcullis> ${PROJECT_BINARY_DIR}/mutants)
set_tests_properties(bench_reports_mutants PROPERTIES TIMEOUT ${PORTCULLIS_TEST_TIMEOUT} RESOURCE_LOCK gl SKIP_RETURN_CODE 77 LABELS "not_sanitized;not_by_clang")
