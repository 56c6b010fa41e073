# Reader of JSON scenes.
find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
target_sources(host_import PRIVATE json.c json_place.c json_node.c json_placement.c json_polygon.c json_document.c json_source.c
  json_box.c json_geometry.c json_models.c json_movers.c json_zones.c json_extras.c name_table.c)
target_link_libraries(host_import PRIVATE PkgConfig::JANSSON)
