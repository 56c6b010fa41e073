// A host in C++: opens a scene with a culler by name, looks once, prints how many items are seen.
// SPDX-License-Identifier: MIT
#include <portcullis/scene.h>

#include <cstdio>
#include <string>

int main(int argc, char **argv)
{
    if (argc != 3) return 2;
    const std::string chain = argv[2];
    cull_scene_options options{};
    options.struct_size = sizeof options;
    options.chain = chain.c_str();
    cull_scene *scene = nullptr;
    cull_scene_view *view = nullptr;
    if (cull_scene_open(argv[1], &options, &scene) != CULL_OK || cull_scene_view_open(scene, &view) != CULL_OK) return 1;
    cull_camera camera{};
    camera.struct_size = sizeof camera;
    camera.forward[2] = -1;
    camera.up[1] = 1;
    camera.fovy_deg = 60;
    camera.aspect = 1;
    camera.near_m = 0.0625;
    camera.far_m = 1000;
    camera.width_px = camera.height_px = 64;
    camera.purpose = CULL_VIEW_MAIN;
    cull_visible seen{};
    seen.struct_size = sizeof seen;
    if (cull_scene_cull(view, &camera, &seen) != CULL_OK) return 1;
    std::printf("%llu items\n", static_cast<unsigned long long>(seen.items));
    cull_scene_close(scene);
    return 0;
}
