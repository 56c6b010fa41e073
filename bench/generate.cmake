# Generated scenes: needs nothing but files and memory.
add_library(bench_generate STATIC generate.c generate_text.c generate_boxes.c generate_obj.c generate_shapes.c generate_rooms.c
  generate_plan.c generate_json.c generate_path.c generate_zoned.c generate_maze.c
  generate_house.c generate_house_fill.c generate_house_rich.c generate_house_scene.c generate_land.c generate_flagship.c generate_movers.c
  generate_models.c generate_museum.c generate_street.c generate_demo.c generate_terrain.c generate_forest.c)
target_link_libraries(bench_generate PUBLIC host_core PRIVATE portcullis_flags m)
