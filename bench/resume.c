// A shard's journal: see resume.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "resume.h"

#include "../host/core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

enum { PATH_BYTES = 4096, SYNC_EVERY_S = 1, ENTRY_BYTES_MOST = 1 << 30 };
enum { ENTRY_TRUTH = 1, ENTRY_PASS = 2 };
static const char MAGIC[] = "portcullis journal 1\n";

// The payload stands behind it, and behind that the hash of both.
typedef struct entry { uint32_t kind, size, strategy, pass, view, spare; } entry;

// ---- Reading ----

// The entry at j->bytes + at; 0: there is no whole one. *payload need not be aligned.
static int entry_at(const resume *j, size_t at, entry *out, const char **payload)
{
    uint64_t hash;
    if (j->size - at < sizeof *out + sizeof hash) return 0;
    memcpy(out, j->bytes + at, sizeof *out);
    if (out->size > ENTRY_BYTES_MOST || j->size - at - sizeof *out - sizeof hash < out->size) return 0;
    *payload = j->bytes + at + sizeof *out;
    memcpy(&hash, *payload + out->size, sizeof hash);
    return hash == XXH3_64bits(j->bytes + at, sizeof *out + out->size);
}

static size_t entry_bytes(const entry *e)
{
    return sizeof *e + e->size + sizeof(uint64_t);
}

static uint32_t *done_of(const resume *j, uint32_t strategy, uint32_t pass)
{
    return &j->done[(size_t)strategy * records_passes(j->q) + pass];
}

// A pass of views one behind the other; what does not follow is measured again.
static void take_pass(resume *j, const entry *e, const char *payload, records *records)
{
    const int counts = e->pass == records_counting_pass(j->q);
    if (e->strategy >= j->q->strategy_count || e->pass >= records_passes(j->q)) return;
    uint32_t *done = done_of(j, e->strategy, e->pass);
    if (e->view != j->range.first + *done || e->view >= j->range.end) return;
    if (e->size != sizeof(pass_record) + (counts ? sizeof(counted_record) : 0)) return;
    memcpy(records_pass(records, e->strategy, e->pass, e->view), payload, sizeof(pass_record));
    if (counts) memcpy(records_counted(records, e->strategy, e->view), payload + sizeof(pass_record), sizeof(counted_record));
    ++*done;
}

static void take_entries(resume *j, records *records)
{
    entry e;
    const char *payload;
    for (j->good = j->at; entry_at(j, j->good, &e, &payload); j->good += entry_bytes(&e))
        if (e.kind == ENTRY_PASS) take_pass(j, &e, payload, records);
}

result resume_truth(const resume *j, uint32_t strategy, report *r, truth *t)
{
    entry e;
    const char *payload;
    for (size_t at = j->at; at < j->good && entry_at(j, at, &e, &payload); at += entry_bytes(&e)) {
        truth_view view;
        if (e.kind != ENTRY_TRUTH || e.strategy != strategy || e.view != t->views.count || e.view >= j->range.end) continue;
        if (e.size < sizeof view || (e.size - sizeof view) % sizeof(truth_item)) continue;
        const size_t count = (e.size - sizeof view) / sizeof(truth_item);
        memcpy(&view, payload, sizeof view);
        view.first = (uint32_t)t->items.count;
        view.count = (uint32_t)count;
        if (!buffer_append(&t->items, payload + sizeof view, count) || !buffer_append(&t->views, &view, 1)) return report_no_memory(r, NULL);
        const truth_item *items = (const truth_item *)t->items.items + view.first;
        for (size_t i = 0; i < count; ++i)
            if (items[i].item >= t->scene->item_count + t->scene->mover_count)
                return report_error(r, j->path, 0, "names items that the scene has not; delete it");
    }
    return RESULT_OK;
}

view_range resume_left(const resume *j, uint32_t strategy, uint32_t pass)
{
    return (view_range){j->range.first + (j->file ? *done_of(j, strategy, pass) : 0), j->range.end};
}

// ---- Writing ----

static result put(resume *j, const void *bytes, size_t size, report *r)
{
    const char *at = bytes;
    while (size) {
        const ssize_t done = write(j->file, at, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return report_error(r, j->path, 0, "cannot write the journal: %s; make room, and start this shard again", strerror(errno));
        at += done;
        size -= (size_t)done;
    }
    return RESULT_OK;
}

// A killed process loses nothing that was written; a machine that loses power the last second.
static void sync_now_and_then(resume *j)
{
    const time_t now_s = time(NULL);
    if (now_s - j->synced_s < SYNC_EVERY_S) return;
    (void)fdatasync(j->file);
    j->synced_s = now_s;
}

// In one write, so that what a kill cuts is the end only.
static result put_entry(resume *j, const entry *e, const void *const parts[2], const size_t sizes[2], report *r)
{
    const allocator *memory = j->q->services->memory;
    const size_t size = entry_bytes(e);
    char *bytes = memory_alloc(memory, size, 1);
    if (!bytes) return report_no_memory(r, NULL);
    memcpy(bytes, e, sizeof *e);
    if (sizes[0]) memcpy(bytes + sizeof *e, parts[0], sizes[0]);
    if (sizes[1]) memcpy(bytes + sizeof *e + sizes[0], parts[1], sizes[1]);
    const uint64_t hash = XXH3_64bits(bytes, size - sizeof hash);
    memcpy(bytes + size - sizeof hash, &hash, sizeof hash);
    const result done = put(j, bytes, size, r);
    memory_free(memory, bytes, size, 1);
    sync_now_and_then(j);
    return done;
}

result resume_keep_truth(resume *j, uint32_t strategy, const truth *t, report *r)
{
    if (!j->file) return RESULT_OK;
    const uint32_t view = (uint32_t)t->views.count - 1;
    const truth_view *v = (const truth_view *)t->views.items + view;
    const size_t sizes[] = {sizeof *v, v->count * sizeof(truth_item)};
    const void *const parts[] = {v, (const truth_item *)t->items.items + v->first};
    return put_entry(j, &(entry){.kind = ENTRY_TRUTH, .size = (uint32_t)(sizes[0] + sizes[1]), .strategy = strategy, .view = view}, parts, sizes, r);
}

result resume_keep_pass(resume *j, const resume_place *at, const records *records, report *r)
{
    if (!j->file) return RESULT_OK;
    const int counts = at->pass == records_counting_pass(j->q);
    const size_t sizes[] = {sizeof(pass_record), counts ? sizeof(counted_record) : 0};
    const void *const parts[] = {records_pass(records, at->strategy, at->pass, at->view), records_counted(records, at->strategy, at->view)};
    const entry e = {.kind = ENTRY_PASS, .size = (uint32_t)(sizes[0] + sizes[1]), .strategy = at->strategy, .pass = at->pass, .view = at->view};
    return put_entry(j, &e, parts, sizes, r);
}

// ---- Opening ----

// What the first bytes of this shard's journal are.
static char *head_of(const bench_request *q, const bench_result *b, size_t *size)
{
    const int length = snprintf(NULL, 0, "%s%u of %u by %s\n%s\n", MAGIC, q->shard.index, q->shard.count, b->gl_name, q->shard.identity);
    char *text = length < 0 ? NULL : memory_alloc(q->services->memory, (size_t)length + 1, 1);
    if (!text) return NULL;
    snprintf(text, (size_t)length + 1, "%s%u of %u by %s\n%s\n", MAGIC, q->shard.index, q->shard.count, b->gl_name, q->shard.identity);
    *size = (size_t)length;
    return text;
}

static result begin_journal(resume *j, const char *head, size_t size, report *r)
{
    j->file = open(j->path, O_RDWR | O_CREAT, 0666);
    if (j->file < 0) {
        j->file = 0;
        return report_error(r, j->path, 0, "cannot write it: %s; choose another place for the results", strerror(errno));
    }
    struct flock alone = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(j->file, F_SETLK, &alone) != 0 && (errno == EACCES || errno == EAGAIN))
        return report_error(r, j->path, 0, "another process is at this shard; wait for it, or give each its own");
    const size_t keep = j->good;
    if (ftruncate(j->file, (off_t)keep) != 0 || lseek(j->file, 0, SEEK_END) < 0)
        return report_error(r, j->path, 0, "cannot write it: %s; choose another place for the results", strerror(errno));
    return keep ? RESULT_OK : put(j, head, size, r);
}

// A head that was cut off is no journal of another run: nothing has been measured.
static result read_journal(resume *j, const char *head, size_t size, records *records, report *r)
{
    struct stat status;
    if (stat(j->path, &status) != 0 || status.st_size == 0) return RESULT_OK;
    const result done = file_read_most(j->path, SIZE_MAX >> 1, j->q->services->memory, r, &j->bytes, &j->size);
    if (done != RESULT_OK) return done;
    if (memcmp(j->bytes, head, j->size < size ? j->size : size) != 0)
        return report_error(r, j->path, 0, "is of a shard with another scene, path, options, program or driver; delete it to begin anew");
    if (j->size < size) return RESULT_OK;
    j->at = size;
    take_entries(j, records);
    return RESULT_OK;
}

static void tell_kept(const resume *j, report *r)
{
    uint64_t views = 0;
    for (size_t i = 0; i < (size_t)j->q->strategy_count * records_passes(j->q); ++i) views += j->done[i];
    if (j->good) report_note(r, "%s: goes on; %llu views of passes are kept", j->path, (unsigned long long)views);
}

result resume_open(const bench_request *q, bench_result *b, view_range range, report *r, resume *out)
{
    const allocator *memory = q->services->memory;
    *out = (resume){.q = q, .range = range};
    if (!q->shard.count) return RESULT_OK;
    size_t size = 0;
    char *head = head_of(q, b, &size);
    out->path = memory_alloc(memory, PATH_BYTES, 1);
    out->done = memory_alloc_zeroed(memory, (size_t)q->strategy_count * records_passes(q), sizeof *out->done);
    result done = head && out->path && out->done ? RESULT_OK : report_no_memory(r, NULL);
    if (done == RESULT_OK && snprintf(out->path, PATH_BYTES, "%s.journal", q->shard.part) >= PATH_BYTES)
        done = report_error(r, q->shard.part, 0, "the name is too long; shorten it");
    if (done == RESULT_OK) done = read_journal(out, head, size, b->records, r);
    if (done == RESULT_OK) done = begin_journal(out, head, size, r);
    if (done == RESULT_OK) tell_kept(out, r);
    memory_free(memory, head, size + 1, 1);
    return done;
}

void resume_close(resume *j, result done)
{
    if (!j->q) return;
    const allocator *memory = j->q->services->memory;
    if (j->file) close(j->file);
    if (j->file && done == RESULT_OK) unlink(j->path);
    memory_free(memory, j->path, PATH_BYTES, 1);
    memory_free(memory, j->bytes, j->size + 1, 1);
    memory_free(memory, j->done, (size_t)j->q->strategy_count * records_passes(j->q), sizeof *j->done);
    *j = (resume){0};
}
