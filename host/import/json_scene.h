// A JSON scene as it is imported: all files that it includes, and the names of their parts. Read in passes over the files,
// because a part may name one that comes later, or that another file holds.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_JSON_SCENE_H
#define PORTCULLIS_IMPORT_JSON_SCENE_H

#include "json_node.h"
#include "json_placement.h"
#include "name_table.h"
#include "reader.h"

enum { NODES_MOST = 1 << 24 };   // entries of one list: memory gives out long before
enum { NAME_BYTES_MOST = 4095 }; // of a part's name with the prefixes of all includes round it

typedef struct json_document { // one file of the scene
    json_file file;     // of json_source.c, shared by all documents of that path
    const char *prefix; // of its names: "" or "house/"
    builder_transform place;
    const struct json_document *above; // that includes it, or NULL
} json_document;

typedef struct door_entry {
    door_state at_rest;
} door_entry;

typedef struct json_scene {
    const reader_job *job;
    arena memory;
    buffer documents; // json_document *, included ones before those that include them
    buffer door_list; // door_entry
    name_table zones, portals, doors, movers, paths;
    name_table moved;      // movers of doors: the door's place in door_list
    buffer sources;        // of json_source.c
    name_table source_names;         // by path
    uint64_t parsed_bytes, included_bytes; // of JSON: of different files; of all documents
    buffer models, meshes;           // of json_models.c
    name_table model_names, mesh_names; // by path
    builder_bounds bounds; // of what the builder has so far
    uint64_t hull_triples; // tried so far
    size_t zones_added;
    uint32_t errors_before; // of the report: one more, and what is wrong has been told
    uint32_t pieces;       // files read, copies made: bounded, because includes multiply
    void *user;            // of json_beside's caller
    uint32_t object;       // that boxes and walls without a name go to; SCENE_NONE: a new one
} json_scene;

// One entry of a list at hand. Every pass calls such a function for each entry, in the files' order.
typedef struct json_entry {
    json_scene *scene;
    const json_document *document;
    json_node node;
} json_entry;
typedef result (*entry_reader)(const json_entry *e);
result entries_read(json_scene *s, const char *list, entry_reader read); // over all documents; sets the builder's transform to the document's

// ---- Passes ----
result documents_load(json_scene *s);  // parses, follows includes of .json
result geometry_read(json_scene *s);   // other includes, meshes, boxes, walls
result zones_read(json_scene *s);
result portals_read(json_scene *s);
result doors_list(json_scene *s); // before the movers, which stand as their doors say
result movers_read(json_scene *s);
result doors_read(json_scene *s);
result lights_read(json_scene *s);
result paths_read(json_scene *s);

// ---- Scenes with brushes, for the compiler ----
// All that stands beside the brushes into the job's builder, then `more` over the same documents; whose lists those are:
// "brushes", "zone_info", "starts". Zones and portals by hand are refused.
typedef struct json_more { result (*read)(json_scene *s); void *user; } json_more;
result json_beside(const reader_job *j, const json_more *more);

// ---- Files, each read once ----
typedef struct source_text { const char *bytes; char *own; size_t size; } source_text; // own: to be freed as file_read says, or NULL
result source_add(json_scene *s, const char *path, source_text text, json_file *out); // parses; path and text stay; frees `own` where it fails
result source_find(const json_entry *e, const json_node *file, const char *path, json_file *out);
void sources_open(json_scene *s);
void sources_free(json_scene *s);
void models_open(json_scene *s);
void models_free(json_scene *s);
result model_find(const json_entry *e, const json_node *file, const scene **out); // of a mover: a scene of its own
result mesh_find(const json_entry *e, const json_node *file, const char *path, const scene_builder **out); // static: to be appended

// ---- What the passes share ----
typedef enum box_side { BOX_OUT, BOX_IN } box_side; // where its faces look
enum { BOX_FACES = 6 };                             // -x, +x, -y, +y, -z, +z
typedef struct json_box { double min[3], max[3]; const char *material; box_side side; uint32_t omitted; } json_box; // omitted: bit a face
result box_read(const json_node *n, const char *const *known_keys, json_box *out);
uint32_t material_flags_of_name(const char *name); // MATERIAL_*: what starts with * is see-through, as in a .map
int box_has_face(const json_box *b, int face);                         // not omitted, and with an area
void box_face(const json_box *b, int face, double (*out_points)[3]); // 4, counterclockwise from where it looks
result entry_no_memory(const json_entry *e);
// Tells what a builder's call says about the entry, unless the fault was told already. fault: behind "the WHAT "; may be NULL.
result entry_told(const json_entry *e, result done, const char *what, const char *fault);
result entry_place(const json_entry *e, const builder_transform *inner); // sets the builder's transform: inner within the document's
// Name of a part in the whole scene: the document's prefix before it. Of a reference that begins with '/': the rest alone.
result entry_name(const json_entry *e, const char *name, const char **out);
result entry_new_name(const json_entry *e, name_table *names, const char *kind, uint32_t number, const char **out); // by its key "name"
result entry_own(const json_entry *e, name_table *names, named **out); // of an entry whose name was new once
result entry_refer(const json_entry *e, const json_node *reference, const name_table *names, const char *kind, uint32_t *out);
result entry_file(const json_entry *e, const json_node *file, const char **out_path); // relative to the document's file
result entry_text(const json_entry *e, const json_node *file, const char *path, char **out_text, size_t *out_size); // free as file_read says
result entry_count_piece(const json_entry *e);
result entry_room(const json_entry *e, uint64_t size_each, uint32_t copies); // for as many of scene_builder_size each
result entry_chain(const json_entry *e, const char **out); // of its key "chain"; as it was when there is none
result entry_points(const json_node *list, size_t least, size_t most, double (*out)[3], size_t *out_count);

#endif
