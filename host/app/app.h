// The one executable: its subcommands, and what they share.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_H
#define PORTCULLIS_HOST_APP_H

#include "../core/chain.h"
#include "../core/search_path.h"
#include "../import/import.h"
#include "../render/render.h"

#define APP_VIEWS "FILE|auto:[walk:|drive:|street:|roofs:|turn:|edges:]N|path:NAME" // what --views takes

enum { EXIT_GOOD = 0, EXIT_CHECK_FAILED = 1, EXIT_USAGE = 2, EXIT_NO_GL = 3 };

typedef int (*app_command)(int argc, char **argv); // argv[0] is "portcullis NAME"; returns the exit code

int command_plugins(int argc, char **argv);
int command_info(int argc, char **argv);
int command_compile(int argc, char **argv);
int command_bench(int argc, char **argv);
int command_merge(int argc, char **argv);
int command_render(int argc, char **argv);
int command_explain(int argc, char **argv);
int command_first_miss(int argc, char **argv);
int command_stress(int argc, char **argv);
int command_auto(int argc, char **argv);
int command_view(int argc, char **argv);
int command_generate(int argc, char **argv);
int command_check(int argc, char **argv);
int command_new_culler(int argc, char **argv);

// What every command that loads cullers holds.
typedef struct app {
    const allocator *memory;
    report report;
    arena texts;
    host_services services;
    search_path search;
    loader *plugins;
    scene *scene;
} app;

enum { APP_PLUGINS_MOST = 64 };
typedef struct app_plugin_files {
    const char *files[APP_PLUGINS_MOST];
    uint32_t count;
} app_plugin_files;

// Search path: explicit files, PORTCULLIS_PLUGIN_PATH, the user's folder, the install's, the build tree beside the executable.
result app_open(app *a, const app_plugin_files *files);
void app_close(app *a);
int app_exit_code(result done);
result app_check_gl(app *a, const renderer *g); // RESULT_NO_GL with a line where the driver made errors; g may be NULL

enum { APP_SIDE_MOST = 8192 }; // pixels of a picture, or samples
typedef struct app_size { uint32_t width_px, height_px; } app_size;
int parse_size(const char *text, app_size *out);                                     // "1280x720"; 0 when it is none
int parse_count(const char *text, uint32_t least, uint32_t most, uint32_t *out);     // 0 when it is none
int parse_ms(const char *text, double *out);                                         // 0 to 100000 milliseconds; 0 when it is none
int parse_doors(const char *text, door_state *out);                                  // "open", "shut"
typedef enum doors_choice { DOORS_ALL_OPEN, DOORS_ALL_SHUT, DOORS_OF_SCENE } doors_choice; // OF_SCENE: as its file says, open in maps
int app_doors_parse(const char *text, doors_choice *out);                            // "open", "shut", "scene"; 0 when it is none
door_state app_doors_import(doors_choice d);                                         // for import_options
const door_state *app_doors_of(const doors_choice *d);                               // of all doors; NULL: at rest
const char *scene_label(const char *path, arena *texts);                             // "a/b/e1m1.map" -> "e1m1"; NULL: no memory

#endif
