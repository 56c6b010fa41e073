// The plugin loader: see loader.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "loader.h"
#include "builtin.h"
#include "library_file.h"

#include <dirent.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PLUGINS_A_LIBRARY_MOST = 64, OPTIONS_MOST = 256, ID_BYTES_MOST = 63, PATH_BYTES = 4096, LIST_BYTES = 512 };

typedef struct library {
    void *handle;
    const char *path;
} library;

typedef struct file_id { dev_t device; ino_t number; } file_id; // one file has one, whatever its paths

struct loader {
    const allocator *memory;
    arena texts;
    buffer files, folders; // const char *
    buffer plugins;        // loaded_plugin
    buffer refused;        // refused_plugin
    buffer libraries;      // library
    buffer looked_at;      // file_id
};

static result add_text(loader *l, buffer *to, const char *text)
{
    const char *copy = arena_text(&l->texts, text, strlen(text));
    return copy && buffer_append(to, &copy, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// A name without a slash would be searched for by the system's rules; here it is a file like any other.
static result add_file(loader *l, const char *name)
{
    char path[PATH_BYTES];
    const int length = snprintf(path, sizeof path, "%s%s", strchr(name, '/') ? "" : "./", name);
    return add_text(l, &l->files, length > 0 && (size_t)length < sizeof path ? path : name);
}

static result add_places(loader *l, const loader_options *o)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < o->file_count && done == RESULT_OK; ++i) done = add_file(l, o->files[i]);
    for (uint32_t i = 0; i < o->folder_count && done == RESULT_OK; ++i)
        if (o->folders[i][0]) done = add_text(l, &l->folders, o->folders[i]); // an empty name is no folder, least of all the root
    return done;
}

result loader_open(const loader_options *o, const allocator *memory, report *r, loader **out)
{
    loader *l = memory_alloc_zeroed(memory, 1, sizeof *l);
    if (!l) return report_no_memory(r, NULL);
    l->memory = memory;
    l->texts = arena_make(memory);
    l->files = buffer_make(memory, sizeof(const char *));
    l->folders = buffer_make(memory, sizeof(const char *));
    l->plugins = buffer_make(memory, sizeof(loaded_plugin));
    l->refused = buffer_make(memory, sizeof(refused_plugin));
    l->libraries = buffer_make(memory, sizeof(library));
    l->looked_at = buffer_make(memory, sizeof(file_id));
    uint32_t count;
    const cull_plugin *const *builtin = builtin_plugins(&count);
    int failed = add_places(l, o) != RESULT_OK;
    for (uint32_t i = 0; i < count; ++i) failed = failed || !buffer_append(&l->plugins, &(loaded_plugin){builtin[i], NULL}, 1);
    if (failed) {
        loader_close(l);
        return report_no_memory(r, NULL);
    }
    *out = l;
    return RESULT_OK;
}

static void library_close(void *handle)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    (void)handle; // a closed library has no symbols in a report
#else
    dlclose(handle);
#endif
}

void loader_close(loader *l)
{
    if (!l) return;
    const library *libraries = l->libraries.items;
    for (size_t i = 0; i < l->libraries.count; ++i) library_close(libraries[i].handle);
    buffer *const all[] = {&l->files, &l->folders, &l->plugins, &l->refused, &l->libraries, &l->looked_at};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    arena_free(&l->texts);
    memory_free(l->memory, l, 1, sizeof *l);
}

static const cull_plugin *plugin_known(const loader *l, const char *id)
{
    const loaded_plugin *plugins = l->plugins.items;
    for (size_t i = 0; i < l->plugins.count; ++i)
        if (strcmp(plugins[i].plugin->descriptor->id, id) == 0) return plugins[i].plugin;
    return NULL;
}

static int id_is_legal(const char *id)
{
    const size_t length = id ? strnlen(id, ID_BYTES_MOST + 1) : 0;
    return length > 0 && length <= ID_BYTES_MOST && strspn(id, "abcdefghijklmnopqrstuvwxyz0123456789-") == length;
}

// NULL when the descriptor is sound, else what is wrong with it.
static const char *descriptor_fault(const cull_descriptor *d)
{
    if (!d) return "a plugin has no descriptor";
    if (!id_is_legal(d->id)) return "an id is empty, too long, or not of a-z, 0-9 and -";
    if (!d->version || !d->summary) return "its descriptor has no version or summary";
    if (d->option_count > OPTIONS_MOST || (d->option_count && !d->options)) return "its option table is missing or too long";
    for (uint32_t i = 0; i < d->option_count; ++i) {
        if (!d->options[i].key || !d->options[i].fallback || !d->options[i].help) return "an option has no key, fallback or help";
        for (uint32_t k = 0; k < i; ++k)
            if (strcmp(d->options[i].key, d->options[k].key) == 0) return "an option stands twice in its table";
    }
    return NULL;
}

static const char *plugin_fault(const loader *l, const cull_plugin *p)
{
    if (!p) return "its table holds a NULL plugin";
    const char *fault = descriptor_fault(p->descriptor);
    if (fault) return fault;
    if (!p->create || !p->destroy || !p->build || !p->open || !p->close || !p->get_extension)
        return "one of create, destroy, build, open, close, get_extension is NULL";
    if (!p->select && !p->filter && !p->cross) return "it has no verb: select, filter and cross are all NULL";
    return plugin_known(l, p->descriptor->id) ? "its id is taken by a culler found before it" : NULL;
}

static const char *entry_fault(const loader *l, const cull_exports *entry, library_fault_text *text)
{
    if (!entry) return "it has no symbol " CULL_ENTRY_SYMBOL "; declare it with CULL_ENTRY";
    const char *other_abi = library_abi_fault(entry->abi, text); // the one field that every ABI has
    if (other_abi) return other_abi;
    if (entry->plugin_count == 0 || entry->plugin_count > PLUGINS_A_LIBRARY_MOST || !entry->plugins) return "it lists no plugin, or over 64";
    for (uint32_t i = 0; i < entry->plugin_count; ++i) {
        const char *fault = plugin_fault(l, entry->plugins[i]);
        if (fault) return fault;
        for (uint32_t k = 0; k < i; ++k)
            if (strcmp(entry->plugins[i]->descriptor->id, entry->plugins[k]->descriptor->id) == 0) return "it lists an id twice";
    }
    return NULL;
}

static result refuse(loader *l, const char *path, const char *reason)
{
    refused_plugin refused = {arena_text(&l->texts, path, strlen(path)), arena_text(&l->texts, reason, strlen(reason))};
    if (!refused.path || !refused.reason || !buffer_append(&l->refused, &refused, 1)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static int library_seen(const loader *l, const char *path)
{
    const library *libraries = l->libraries.items;
    for (size_t i = 0; i < l->libraries.count; ++i)
        if (strcmp(libraries[i].path, path) == 0) return 1;
    const refused_plugin *refused = l->refused.items;
    for (size_t i = 0; i < l->refused.count; ++i)
        if (strcmp(refused[i].path, path) == 0) return 1;
    return 0;
}

// By another path too: a folder twice on the search path, a link. What cannot be asked about is nothing known.
static int file_seen(const loader *l, const struct stat *status)
{
    const file_id *seen = l->looked_at.items;
    for (size_t i = 0; i < l->looked_at.count; ++i)
        if (seen[i].device == status->st_dev && seen[i].number == status->st_ino) return 1;
    return 0;
}

static result library_keep(loader *l, void *handle, const char *path, const cull_exports *entry)
{
    const library kept = {handle, arena_text(&l->texts, path, strlen(path))};
    if (!kept.path || !buffer_append(&l->libraries, &kept, 1)) {
        library_close(handle);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t i = 0; i < entry->plugin_count; ++i)
        if (!buffer_append(&l->plugins, &(loaded_plugin){entry->plugins[i], kept.path}, 1)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

// Opens one file unless it was looked at before. Bad ones are refused, not failed.
static result library_open(loader *l, const char *path)
{
    struct stat status;
    if (library_seen(l, path)) return RESULT_OK;
    if (stat(path, &status) == 0) {
        if (file_seen(l, &status)) return RESULT_OK;
        if (!buffer_append(&l->looked_at, &(file_id){status.st_dev, status.st_ino}, 1)) return RESULT_NO_MEMORY;
    }
    library_fault_text text;
    const char *fault = library_path_fault(path, &text);
    if (fault) return refuse(l, path, fault);
    dlerror();
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        const char *reason = dlerror();
        return refuse(l, path, reason ? reason : "the system cannot load it");
    }
    const cull_exports *entry = dlsym(handle, CULL_ENTRY_SYMBOL);
    fault = entry_fault(l, entry, &text);
    if (!fault) return library_keep(l, handle, path, entry);
    const result refused = refuse(l, path, fault);
    library_close(handle);
    return refused;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int is_library(const struct dirent *e)
{
    const size_t length = strlen(e->d_name), suffix = strlen(LOADER_SUFFIX);
    return length > suffix && strcmp(e->d_name + length - suffix, LOADER_SUFFIX) == 0;
}

static result folder_scan(loader *l, const char *folder)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_library, by_name);
    result done = RESULT_OK;
    for (int i = 0; i < count; ++i) {
        char path[PATH_BYTES];
        const int length = snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        if (done == RESULT_OK && length > 0 && (size_t)length < sizeof path) done = library_open(l, path);
        free(entries[i]);
    }
    free(entries);
    return done;
}

static result files_open(loader *l)
{
    const char *const *files = l->files.items;
    for (size_t i = 0; i < l->files.count; ++i)
        if (library_open(l, files[i]) != RESULT_OK) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

// A library that was asked for by name must be good: another of the same id would be taken for it.
static result tell_refused_files(const loader *l, report *r)
{
    const char *const *files = l->files.items;
    const refused_plugin *refused = l->refused.items;
    for (size_t i = 0; i < l->refused.count; ++i)
        for (size_t k = 0; k < l->files.count; ++k)
            if (strcmp(refused[i].path, files[k]) == 0) return report_error(r, files[k], 0, "refused: %s", refused[i].reason);
    return RESULT_OK;
}

result loader_scan(loader *l, report *r)
{
    const char *const *folders = l->folders.items;
    result done = files_open(l);
    for (size_t i = 0; i < l->folders.count && done == RESULT_OK; ++i) done = folder_scan(l, folders[i]);
    return done == RESULT_OK ? RESULT_OK : report_no_memory(r, NULL);
}

static result named_open(loader *l, const char *id)
{
    const char *const *folders = l->folders.items;
    for (size_t i = 0; i < l->folders.count && !plugin_known(l, id); ++i) {
        char path[PATH_BYTES];
        struct stat status;
        const int length = snprintf(path, sizeof path, "%s/%s" LOADER_SUFFIX, folders[i], id);
        if (length < 0 || (size_t)length >= sizeof path || stat(path, &status) != 0) continue;
        if (library_open(l, path) != RESULT_OK) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static void list_add(char list[LIST_BYTES], const char *name)
{
    const size_t used = strlen(list);
    if (used + strlen(name) + 3 < LIST_BYTES) snprintf(list + used, LIST_BYTES - used, "%s%s", used ? ", " : "", name);
}

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static result tell_missing(const loader *l, const char *id, report *r)
{
    char found[LIST_BYTES] = "", bad[LIST_BYTES] = "";
    const loaded_plugin *plugins = l->plugins.items;
    for (size_t i = 0; i < l->plugins.count; ++i) list_add(found, plugins[i].plugin->descriptor->id);
    const refused_plugin *refused = l->refused.items;
    for (size_t i = 0; i < l->refused.count; ++i) {
        const char *name = file_name(refused[i].path);
        if (strncmp(name, id, strlen(id)) == 0 && strcmp(name + strlen(id), LOADER_SUFFIX) == 0)
            return report_error(r, refused[i].path, 0, "refused: %s. Cullers found: %s", refused[i].reason, found);
        list_add(bad, name);
    }
    return report_error(r, NULL, 0, "no culler '%s'; found: %s%s%s. Name one of them, or set PORTCULLIS_PLUGIN_PATH", id, found,
                        *bad ? "; refused, see `portcullis plugins`: " : "", bad);
}

result loader_find(loader *l, const char *id, report *r, const cull_plugin **out)
{
    if (!id_is_legal(id)) return report_error(r, NULL, 0, "'%s' is no culler's name; names are of a-z, 0-9 and -", id);
    result done = files_open(l);
    if (done == RESULT_OK && tell_refused_files(l, r) != RESULT_OK) return RESULT_BAD_INPUT;
    if (done == RESULT_OK && !plugin_known(l, id)) done = named_open(l, id);
    if (done != RESULT_OK) return report_no_memory(r, NULL);
    if (!plugin_known(l, id)) done = loader_scan(l, r); // tells of memory itself
    if (done != RESULT_OK) return done;
    const cull_plugin *plugin = plugin_known(l, id);
    if (!plugin) return tell_missing(l, id, r);
    *out = plugin;
    return RESULT_OK;
}

const loaded_plugin *loader_plugins(const loader *l, uint32_t *count)
{
    *count = (uint32_t)l->plugins.count;
    return l->plugins.items;
}

const refused_plugin *loader_refusals(const loader *l, uint32_t *count)
{
    *count = (uint32_t)l->refused.count;
    return l->refused.items;
}

uint32_t loader_libraries_open(const loader *l)
{
    return (uint32_t)l->libraries.count;
}
