# Readers of meshes: .obj, .ply, .off, .stl.
target_sources(host_import PRIVATE obj.c ply.c ply_header.c off.c stl.c cluster.c mesh_text.c mesh_soup.c mesh_scene.c mesh_triangulate.c)
target_link_libraries(host_import PRIVATE host_mesh)
