# The whole program with one fault in what the bench draws: the files of the fault stand before those of its library.
find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
get_target_property(app_sources portcullis SOURCES)
list(TRANSFORM app_sources PREPEND ${PROJECT_SOURCE_DIR}/host/app/ REGEX "^[^/]") # what is made at build time has a whole path
list(FILTER app_sources EXCLUDE REGEX "\\.h$")
add_library(mutant_app OBJECT ${app_sources})
add_dependencies(mutant_app portcullis)
target_include_directories(mutant_app PRIVATE $<TARGET_PROPERTY:portcullis,INCLUDE_DIRECTORIES>)
target_compile_definitions(mutant_app PRIVATE "PORTCULLIS_VERSION=\"mutant\"")
target_link_libraries(mutant_app PUBLIC portcullis_flags portcullis_bench portcullis_check host_compile host_core host_import host_render PkgConfig::JANSSON m)

function(portcullis_drawing_mutant name file old new)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/drawing/${name})
  set(from ${PROJECT_SOURCE_DIR}/${file})
  get_filename_component(base ${file} NAME)
  get_filename_component(home ${from} DIRECTORY)
  file(GLOB originals CONFIGURE_DEPENDS ${home}/*.[ch]) # its headers are copied too
  add_custom_command(OUTPUT ${folder}/${base}
    COMMAND ${CMAKE_COMMAND} -DFROM=${home} -DTO=${folder} -DFILE=${base} "-DOLD=${old}" "-DNEW=${new}" -P ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake
    DEPENDS ${originals} ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake VERBATIM)
  add_executable(portcullis_${name} ${folder}/${base})
  set_target_properties(portcullis_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/drawing_mutants)
  target_include_directories(portcullis_${name} PRIVATE ${home})
  target_link_libraries(portcullis_${name} PRIVATE mutant_app)
endfunction()

portcullis_drawing_mutant(reorder bench/strategy_chains.c
  "done = render_layout_reorder(s->layout, zone, s->order + s->zones[zone].first, r)" "done = RESULT_OK")
portcullis_drawing_mutant(order bench/strategy_chains.c
  "render_layout_reorder(s->layout, zone, s->order + s->zones[zone].first, r)" "render_layout_reorder(s->layout, zone, s->q->scene->zone_items + s->q->scene->zones[zone].first_item, r)")
portcullis_drawing_mutant(movers bench/strategy_driver.c
  "renderer_draw_movers(s->g, s->layout, movers, count)" "count = 0")
portcullis_drawing_mutant(runs bench/strategy_driver.c
  "renderer_draw(s->g, s->layout, zone, runs, count)" "renderer_draw(s->g, s->layout, zone, runs, count -= count > 1)")
