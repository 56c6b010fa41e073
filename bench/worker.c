// A worker: see worker.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "worker.h"

#include <pthread.h>

struct worker {
    worker_request q;
    const allocator *memory;
    pthread_t thread;
    pthread_mutex_t lock; // of the rest
    pthread_cond_t changed;
    uint64_t given, done;
    enum { WORKER_ALONE, WORKER_RUNS, WORKER_ENDS } state; // ALONE: without a thread
};

static void *work(void *user)
{
    worker *w = user;
    pthread_mutex_lock(&w->lock);
    for (;;) {
        while (w->done == w->given && w->state == WORKER_RUNS) pthread_cond_wait(&w->changed, &w->lock);
        if (w->done == w->given) break;
        const uint64_t job = w->done + 1;
        pthread_mutex_unlock(&w->lock);
        w->q.run(w->q.context, job);
        pthread_mutex_lock(&w->lock);
        w->done = job;
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

worker *worker_open(const worker_request *q, const allocator *memory)
{
    worker *w = memory_alloc_zeroed(memory, 1, sizeof *w);
    if (!w) return NULL;
    w->q = *q;
    w->memory = memory;
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
    w->state = WORKER_RUNS;
    if (pthread_create(&w->thread, NULL, work, w) != 0) w->state = WORKER_ALONE;
    return w;
}

void worker_close(worker *w)
{
    if (!w) return;
    pthread_mutex_lock(&w->lock);
    const int has_thread = w->state == WORKER_RUNS;
    if (has_thread) w->state = WORKER_ENDS;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    if (has_thread) pthread_join(w->thread, NULL);
    pthread_cond_destroy(&w->changed);
    pthread_mutex_destroy(&w->lock);
    memory_free(w->memory, w, 1, sizeof *w);
}

uint64_t worker_give(worker *w)
{
    pthread_mutex_lock(&w->lock);
    const uint64_t job = ++w->given;
    const int is_alone = w->state == WORKER_ALONE;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    if (is_alone) {
        w->q.run(w->q.context, job);
        w->done = job;
    }
    return job;
}

void worker_wait(worker *w, uint64_t job)
{
    pthread_mutex_lock(&w->lock);
    while (w->done < job) pthread_cond_wait(&w->changed, &w->lock);
    pthread_mutex_unlock(&w->lock);
}
