# Generated scenes: needs nothing but files and memory.
add_library(bench_generate STATIC generate.c generate_text.c generate_boxes.c generate_obj.c generate_shapes.c generate_rooms.c
  generate_models.c generate_museum.c generate_street.c generate_demo.c)
target_link_libraries(bench_generate PUBLIC host_core PRIVATE portcullis_flags m)
