# Mutants: each plugin broken at five places that it has, each able to lose a pixel. The bench must report every one.
# Only the sources that hold the place are compiled anew, those that include it where it is a header; the rest is the plugin's own.
function(portcullis_mutant plugin name file old new)
  set(from ${PROJECT_SOURCE_DIR}/plugins/${plugin})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/mutants/${plugin}-${name})
  set(target mutant_${plugin}_${name})
  get_target_property(sources plugin_${plugin} SOURCES)
  set(changed)
  foreach(source ${sources})
    file(STRINGS ${from}/${source} includes REGEX "#include \"${file}\"")
    if(source STREQUAL file OR includes)
      list(APPEND changed ${source})
    endif()
  endforeach()
  if(NOT changed)
    message(FATAL_ERROR "no source of plugin_${plugin} holds ${file}")
  endif()
  list(TRANSFORM changed PREPEND ${folder}/ OUTPUT_VARIABLE copies)
  string(REPLACE ";" "|" others "${changed}")
  string(REPLACE "." "[.]" others "${others}")
  file(GLOB originals CONFIGURE_DEPENDS ${from}/*.[ch])
  string(REPLACE ${from} ${folder} all_copies "${originals}")
  add_custom_command(OUTPUT ${all_copies}
    COMMAND ${CMAKE_COMMAND} -DFROM=${from} -DTO=${folder} -DFILE=${file} "-DOLD=${old}" "-DNEW=${new}" -P ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake
    DEPENDS ${originals} ${CMAKE_CURRENT_SOURCE_DIR}/mutate.cmake VERBATIM)
  add_library(${target} MODULE ${copies} "$<FILTER:$<TARGET_OBJECTS:plugin_${plugin}>,EXCLUDE,/(${others})[.]o>")
  target_link_libraries(${target} PRIVATE portcullis_flags portcullis_api m)
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${plugin} SUFFIX ".culler.so"
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/mutants/${plugin}-${name})
  if(PORTCULLIS_SANITIZE OR NOT PORTCULLIS_MUTANTS) # their test is not run there, and kernels with sanitizers take a minute each
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
  foreach(source ${changed}) # each file's own instruction set
    get_source_file_property(options ${from}/${source} DIRECTORY ${from} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${folder}/${source} PROPERTIES COMPILE_OPTIONS "${options}")
    endif()
  endforeach()
endfunction()

portcullis_mutant(frustum drops-one-in-1000 walk_body.h
  "(1u << left) - 1 : 0xffffu;" "(1u << left) - 1 : level || block % 63 ? 0xffffu : 0xfffeu;")
portcullis_mutant(frustum shrinks-a-plane walk_small_body.h
  "cull_block_planes(from, volume->planes);" "cull_block_planes(from, volume->planes); volume->planes[0].limit += 0.5f;")
portcullis_mutant(frustum skips-a-child walk_body.h
  "out->cut &= out->touching;" "out->touching &= 0xff7fu; out->cut &= out->touching;")
portcullis_mutant(frustum loses-the-last-run walk_body.h
  "    return run_count;" "    return run_count - (run_count > 8);")
portcullis_mutant(frustum takes-the-near-corner walk_small_body.h
  "cull_block_planes(from, volume->planes);" "cull_block_planes(from, volume->planes); for (uint32_t k = 0; k < from->plane_count; k++) volume->planes[k].inner_y = 80 - volume->planes[k].inner_y;")

portcullis_mutant(portal skips-a-portal-in-8 portal.c
  "if (c->clip == CLIP_FLOOD) return CULL_CROSS_SAME;" "if (portal % 8 == 1) return CULL_CROSS_NONE;")
portcullis_mutant(portal shrinks-the-edges narrow.c
  "plane_add(n, cull_guard_plane(&n->guard, normal, 0))" "plane_add(n, cull_guard_plane(&n->guard, normal, -0.0625))")
portcullis_mutant(portal drops-what-straddles narrow.c
  "if (e.most < 0) n->count = 0;" "if (e.least < 0 && e.most < 1) n->count = 0;")
portcullis_mutant(portal takes-the-wrong-side narrow.c
  "{-(double)own.x, -(double)own.y, -(double)own.z}" "{(double)own.x, (double)own.y, (double)own.z}")
portcullis_mutant(portal ends-behind-the-portal narrow.c
  "cull_plane_outward(behind, offset, n->guard.radius)" "cull_plane_outward(behind, offset - 2, n->guard.radius)")

if(TARGET plugin_bsp)
  portcullis_mutant(bsp skips-a-far-child-in-4 walk_body.h
    "if (two) steps" "if (two && own->node % 4) steps")
  portcullis_mutant(bsp drops-what-is-cut walk_body.h
    "*out_cut = cut & todo;" "todo &= ~(cut & 1); *out_cut = cut & todo;")
  portcullis_mutant(bsp takes-the-backs walk_body.h
    "return ~lanes_negative(lanes_add(lanes_add(lanes_add(x, y), z)" "return lanes_negative(lanes_add(lanes_add(lanes_add(x, y), z)")
  portcullis_mutant(bsp shrinks-the-openings flow_shape.c
    "margin = {f->guard_tangents, f->guard_share" "margin = {-0.02, f->guard_share")
  portcullis_mutant(bsp forgets-the-second-window flow.c
    "slot->bounds = window_bounds_union(slot->bounds, w->bounds);" "slot->bounds.u0 *= 1;")
  portcullis_mutant(bsp skips-an-opening-in-8 flow.c
    "i < cell->opening_count; i++" "i < cell->opening_count; i += i % 8 == 1 ? 2u : 1u")
endif()

portcullis_mutant(octree shrinks-a-plane walk_segments_body.h
  "cull_block_planes(q->volumes, planes);" "cull_block_planes(q->volumes, planes); planes[0].limit += 0.5f;")
portcullis_mutant(octree skips-a-leaf-in-61 walk_segments_body.h
  "s->visible[s->places[i]] = judge" "s->visible[s->places[i]] = s->leaves[i] % 61 == 0 ? 0 : judge")
portcullis_mutant(octree drops-what-a-parent-cuts walk_body.h
  "out->cut &= out->touching;" "out->touching &= ~(out->cut & 0x80u); out->cut &= out->touching;")
portcullis_mutant(octree forgets-the-last-of-a-leaf walk_segments_body.h
  "s->w.planes, s->planes[i]);" "s->w.planes, s->planes[i]) & ALL_ITEMS >> 1;")
portcullis_mutant(octree keeps-boxes-too-small index.c
  "firsts_fill(b, l, children, out->firsts);" "firsts_fill(b, l, children, out->firsts); for (int i = 0; l == 2 && i < 16; i++) out->boxes[64 + i] = out->boxes[16 + i];")
portcullis_mutant(octree loses-the-last-run walk_body.h
  "    return run_count;" "    return run_count - (run_count > 8);")

if(TARGET plugin_occlusion)
  portcullis_mutant(occlusion believes-the-last-frame method_twophase.c
    "else walk_pend(w, tree_entry_of_item(w->tree, place));" "else if (w->h->serial % 4 == 0) walk_pend(w, tree_entry_of_item(w->tree, place));")
  portcullis_mutant(occlusion takes-few-pixels-for-none walk.c
    "= a->pixels < UINT32_MAX ? a->pixels : 1;" "= a->pixels > 200 ? a->pixels : 0;")
  portcullis_mutant(occlusion tests-a-corner walk.c
    "const cull_box box = walk_box(w, h->pending[i]);" "cull_box box = walk_box(w, h->pending[i]); box.max = box.min;")
  portcullis_mutant(occlusion skips-a-child method_twophase.c
    "c < n->first_child + n->child_count; c++" "c < n->first_child + n->child_count; c += c % 4 == 1 ? 2u : 1u")
  portcullis_mutant(occlusion ends-after-two-steps method_twophase.c
    "if (h->pending_count && t.steps_left) {" "if (h->pending_count && t.steps_left > STEPS - 2) {")
  portcullis_mutant(occlusion drops-what-its-guess-covers method_twophase.c
    "cover_look(t->cover, &box) == COVER_FULL) walk_pend(w, top.entry);" "cover_look(t->cover, &box) == COVER_FULL) continue;")
  portcullis_mutant(occlusion chc-believes-the-last-frame method_chc.c
    "else chc_queue_add(w, tree_entry_of_item(w->tree, place), 0);" "else if (w->h->serial % 4 == 0) chc_queue_add(w, tree_entry_of_item(w->tree, place), 0);")
  portcullis_mutant(occlusion chc-skips-a-child method_chc.c
    "c < n->first_child + n->child_count; c++" "c < n->first_child + n->child_count; c += c % 4 == 1 ? 2u : 1u")
  portcullis_mutant(occlusion chc-ends-before-the-answers method_chc.c
    "t->c->queue_count || t->c->open_count;" "t->c->queue_count;")
  portcullis_mutant(occlusion chc-drops-what-its-guess-covers method_chc.c
    "== COVER_FULL) chc_queue_add(w, e, 0);" "== COVER_FULL) return;")
  portcullis_mutant(occlusion chc-tests-the-first-of-several chc_queue.c
    ".box = cull_box_union(j->box, unit->box), .count" ".box = j->box, .count")
  portcullis_mutant(occlusion chc-forgets-one-of-several chc.c
    "} else chc_queue_add(w, e, CHC_ALONE);" "} else if (i != t->first) chc_queue_add(w, e, CHC_ALONE);")
  portcullis_mutant(occlusion hiz-widens-what-hides hiz_setup_body.h
    "const double margin = inset * (fabs(a) + fabs(b));" "const double margin = -200 * inset * (fabs(a) + fabs(b));")
  portcullis_mutant(occlusion hiz-tests-the-far-corner hiz_walk_body.h
    "least_w = f_min(least_w, w[i]);" "least_w = f_max(least_w, w[i]);")
  portcullis_mutant(occlusion hiz-takes-an-empty-tile-for-full hiz_test_body.h
    "if (!owner) return 0;" "if (!owner) return column % 7 == 0;")
  portcullis_mutant(occlusion hiz-forgets-the-last-of-a-leaf hiz_walk_body.h
    "lanes = hiz_low_lanes(left);" "lanes = hiz_low_lanes(left) & (level ? 0xffffu : 0x7fffu);")
  portcullis_mutant(occlusion hiz-covers-rows-below hiz_raster_body.h
    "if (pixels) tile_cover_part(b, r, column, row, pixels);" "if (pixels) tile_cover_part(b, r, column, row, pixels | pixels << 8 | pixels << 16);")
endif()

if(TARGET plugin_imagecache)
  portcullis_mutant(imagecache loses-cells-alone-in-a-row rings.c
    "if (least > most) return 0;" "if (least >= most) return 0;")
  portcullis_mutant(imagecache believes-the-last-frame looks.c
    "l->hidden[a.tag] = l->frame;" "l->hidden[a.tag] = l->frame + 1;")
  portcullis_mutant(imagecache moves-seams-inward cut.c
    "return quad_seam_delta(&seam);" "return -quad_seam_delta(&seam);")
  portcullis_mutant(imagecache bounds-a-64th-of-the-way bound.c
    "bound_subtract(eye, capture->eye, moved);" "bound_subtract(eye, capture->eye, moved); for (int k = 0; k < 3; k++) moved[k] /= 64;")
  portcullis_mutant(imagecache shows-far-before-near nodes.c
    "quadrant = near ^ k" "quadrant = near ^ 3u ^ k")
  portcullis_mutant(imagecache takes-items-at-home-only lists.c
    "const cells_run run = c->runs[r];" "const cells_run run = c->runs[r]; if (run.home != cell) continue;")
endif()

add_test(NAME bench_reports_mutants COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/mutants.sh $<TARGET_FILE:portcullis> ${PROJECT_BINARY_DIR}/mutants
  ${PROJECT_SOURCE_DIR}/scenes)
set_tests_properties(bench_reports_mutants PROPERTIES TIMEOUT ${PORTCULLIS_TEST_TIMEOUT} RESOURCE_LOCK gl SKIP_RETURN_CODE 77 LABELS "not_sanitized;not_by_clang")
