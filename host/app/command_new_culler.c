// portcullis new-culler: writes a whole project for a plugin outside this tree, from the texts in new_culler/.
// SPDX-License-Identifier: MIT
// Invariant: the folder is there with all files or not at all; what was there before is never touched.
#define _GNU_SOURCE
#include "../core/file.h"
#include "app.h"
#include "new_culler_text.h"

#include <argp.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_BYTES = 4096, NAME_BYTES_MOST = 63 };

typedef struct arguments { const char *name, *folder; } arguments;

typedef struct project {
    const char *name;
    char folder[PATH_BYTES], draft[PATH_BYTES], made[PATH_BYTES]; // draft: a folder beside it, made: the project in it, renamed at the end
    report report;
} project;

// A file of the project: its name there, NULL for NAME.c, and its text.
typedef struct template { const char *file, *text; } template;
static const template templates[] = {
    {NULL, culler_c_in}, {"CMakeLists.txt", CMakeLists_txt_in}, {"Makefile", Makefile_in}, {"test.sh", test_sh_in}, {"README.md", README_md_in},
};
enum { TEMPLATE_COUNT = sizeof templates / sizeof *templates };

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == ARGP_KEY_ARG && !a->name) a->name = text;
    else if (key == ARGP_KEY_ARG && !a->folder) a->folder = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one NAME and one DIR, not also '%s'", text);
    else if (key == ARGP_KEY_END && !a->folder) argp_error(state, "NAME and DIR are needed");
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

// Also a name of files and of build targets: so it starts with a letter, as an id needn't.
static result check_name(const char *name, report *r)
{
    const size_t length = strlen(name);
    if (length == 0 || length > NAME_BYTES_MOST || strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-") != length || name[0] < 'a')
        return report_error(r, NULL, 0, "'%s' is no name for a culler: take a letter a-z, then a-z, 0-9 and -, at most %d in all", name,
                            (int)NAME_BYTES_MOST);
    return RESULT_OK;
}

static result check_name_is_free(const char *name)
{
    app a;
    uint32_t count = 0;
    result done = app_open(&a, NULL);
    if (done == RESULT_OK) done = loader_scan(a.plugins, &a.report);
    const loaded_plugin *plugins = done == RESULT_OK ? loader_plugins(a.plugins, &count) : NULL;
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i)
        if (strcmp(plugins[i].plugin->descriptor->id, name) == 0)
            done = report_error(&a.report, plugins[i].path, 0, "a culler '%s' is there already; take another name", name);
    app_close(&a);
    return done;
}

static result join(project *p, char to[PATH_BYTES], const char *folder, const char *rest)
{
    const int length = snprintf(to, PATH_BYTES, "%s%s", folder, rest);
    return length > 0 && length < PATH_BYTES ? RESULT_OK : report_error(&p->report, folder, 0, "too long a path; take a shorter one");
}

static result check_folder(project *p, const char *text)
{
    struct stat status;
    size_t length = strlen(text);
    while (length > 1 && text[length - 1] == '/') --length;
    if (length == 0 || length >= PATH_BYTES) return report_error(&p->report, NULL, 0, "'%.40s' is no name for a folder", text);
    snprintf(p->folder, sizeof p->folder, "%.*s", (int)length, text);
    if (lstat(p->folder, &status) == 0)
        return report_error(&p->report, p->folder, 0, "is there already, and is left as it is; name a folder that is not");
    return errno == ENOENT ? RESULT_OK : report_error(&p->report, p->folder, 0, "%s; name a folder that can be made", strerror(errno));
}

// ---- Texts ----

typedef struct replacement { const char *mark, *value; } replacement;

static result fill(const char *text, const char *name, buffer *out)
{
    const replacement all[] = {{"@NAME@", name}, {"@VERSION@", PORTCULLIS_VERSION}};
    while (*text) {
        const replacement *found = NULL;
        size_t length = strcspn(text + 1, "@") + 1; // up to the next mark, if it is one
        for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
            if (strncmp(text, all[i].mark, strlen(all[i].mark)) == 0) found = &all[i];
        if (found) length = strlen(found->mark);
        const char *piece = found ? found->value : text;
        const size_t size = found ? strlen(piece) : length;
        if (size && !buffer_append(out, piece, size)) return RESULT_NO_MEMORY;
        text += length;
    }
    return RESULT_OK;
}

static result write_template(project *p, const template *t)
{
    char path[PATH_BYTES], file[NAME_BYTES_MOST + 4];
    snprintf(file, sizeof file, "/%s.c", p->name);
    result done = join(p, path, p->made, t->file ? "/" : file);
    if (done == RESULT_OK && t->file) {
        char folder[PATH_BYTES];
        memcpy(folder, path, sizeof folder);
        done = join(p, path, folder, t->file);
    }
    buffer text = buffer_make(allocator_heap(), 1);
    if (done == RESULT_OK && fill(t->text, p->name, &text) != RESULT_OK) done = report_no_memory(&p->report, path);
    if (done == RESULT_OK) done = file_write(path, text.items, text.count, &p->report);
    buffer_free(&text);
    return done;
}

// ---- The folder ----

static void remove_draft(const project *p)
{
    char path[2 * PATH_BYTES];
    for (int i = 0; i < TEMPLATE_COUNT; ++i) {
        if (templates[i].file) snprintf(path, sizeof path, "%s/%s", p->made, templates[i].file);
        else snprintf(path, sizeof path, "%s/%s.c", p->made, p->name);
        unlink(path);
    }
    rmdir(p->made);
    rmdir(p->draft);
}

static result refuse_folder(project *p, const char *what)
{
    return report_error(&p->report, p->folder, 0, "%s: %s; name a folder that can be made", what, strerror(errno));
}

// Somebody may have made the folder meanwhile. Where a file system can't rename and refuse at once, an empty one is lost by it.
static int rename_to_nothing(const char *from, const char *to)
{
    if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return 0;
    return errno == EINVAL || errno == ENOSYS ? rename(from, to) : -1;
}

static result write_project(project *p)
{
    result done = join(p, p->draft, p->folder, ".XXXXXX");
    if (done != RESULT_OK) return done;
    if (!mkdtemp(p->draft)) return refuse_folder(p, "cannot make a folder beside it");
    done = join(p, p->made, p->draft, "/project"); // made by mkdir: with the user's usual rights, mkdtemp gives fewer
    if (done == RESULT_OK && mkdir(p->made, 0777) != 0) done = refuse_folder(p, "cannot make it");
    for (int i = 0; i < TEMPLATE_COUNT && done == RESULT_OK; ++i) done = write_template(p, &templates[i]);
    if (done == RESULT_OK && rename_to_nothing(p->made, p->folder) != 0) done = refuse_folder(p, "cannot make it");
    if (done == RESULT_OK) rmdir(p->draft);
    else remove_draft(p);
    return done;
}

int command_new_culler(int argc, char **argv)
{
    static const char about[] = "Writes a whole project for a culler of your own into DIR, which must not exist: source, CMakeLists.txt, Makefile, "
                                "test and README. It is right as it is; change it, and let its test say whether it still is.";
    static const struct argp parser = {NULL, parse, "NAME DIR", about, NULL, NULL, NULL};
    arguments q = {0};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    project p = {.name = q.name, .report = report_to_stderr()};
    result done = check_name(q.name, &p.report);
    if (done == RESULT_OK) done = check_folder(&p, q.folder);
    if (done == RESULT_OK) done = check_name_is_free(q.name);
    if (done == RESULT_OK) done = write_project(&p);
    if (done == RESULT_OK)
        fprintf(stderr, "%s: the culler '%s'. Next: cd %s && cmake -B build && cmake --build build && ctest --test-dir build\n", p.folder, p.name, p.folder);
    return app_exit_code(done);
}
