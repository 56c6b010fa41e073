target_sources(host_import PRIVATE import.c number.c line_scan.c boxes.c
  map.c map_text.c map_texture.c map_entity.c map_stage.c map_brush.c map_fan.c
  pcs.c pcs_read.c pcs_check.c pcs_check_motion.c pcs_check_zones.c
  views.c views_auto.c views_walk.c views_roofs.c views_edges.c views_space.c views_distance.c)
