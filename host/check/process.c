// Processes of checks: see process.h. The message goes through a pipe, the verdict is the exit code; a crash is told by the
// process itself where its handler still runs, else by the signal that ended it.
// SPDX-License-Identifier: MIT
// Invariant: the child writes nothing but its message: stdin is empty, and what the culler prints goes nowhere.
#define _GNU_SOURCE
#include "process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { CODE_PASS = 42, // not 0: a culler that calls exit has not passed
        CODE_FAIL = 1, CODE_SKIP = 77, REGIONS_MOST = 4096, STACK_BYTES = 1 << 16 };

// Of the child only, where a signal handler finds no argument.
typedef struct child_state {
    check_run *run;
    int pipe;
    uint32_t region_count;
    process_region regions[REGIONS_MOST];
} child_state;
static child_state *child;

// ---- In the child ----

void process_name_region(const void *begin, size_t size, const char *name)
{
    if (!child) return;
    child->regions[child->region_count++ % REGIONS_MOST] = (process_region){begin, (const char *)begin + size, name};
}

void process_forget_regions(void)
{
    if (child) child->region_count = 0;
}

static void send_text(const char *text)
{
    size_t left = strlen(text);
    while (left) {
        const ssize_t sent = write(child->pipe, text, left);
        if (sent <= 0) return;
        text += sent;
        left -= (size_t)sent;
    }
}

void process_fail_now(const char *text)
{
    if (child) {
        send_text(text);
        if (*child->run->place) send_text("; in ");
        send_text(child->run->place);
    }
    _exit(CODE_FAIL);
}

void process_pass_now(void)
{
    _exit(CODE_PASS);
}

// The last one named holds: memory is named anew as it is used anew.
static const char *region_of(const void *address)
{
    const char *at = address;
    const uint32_t count = child->region_count, kept = count < REGIONS_MOST ? count : REGIONS_MOST;
    for (uint32_t k = 1; k <= kept; ++k) {
        const process_region *r = &child->regions[(count - k) % REGIONS_MOST];
        if (at >= r->begin && at < r->end) return r->name;
    }
    return NULL;
}

static void on_crash(int number, siginfo_t *info, void *context)
{
    (void)context;
    const int is_access = number == SIGSEGV || number == SIGBUS;
    const char *region = is_access ? region_of(info->si_addr) : NULL;
    if (number == SIGXCPU) process_fail_now("it used up its CPU time and did not end");
    if (region) {
        send_text("it touched ");
        process_fail_now(region);
    }
    process_fail_now(is_access                ? "it crashed: an access to memory that is nobody's"
                     : number == SIGFPE  ? "it crashed: SIGFPE, an integer division"
                     : number == SIGILL  ? "it crashed: SIGILL, an instruction that this CPU has not"
                     : number == SIGABRT ? "it aborted"
                                         : "it crashed");
}

static void handlers_set(void)
{
    static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU};
    void *stack = mmap(NULL, STACK_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    const stack_t other = {.ss_sp = stack, .ss_size = STACK_BYTES};
    if (stack != MAP_FAILED) sigaltstack(&other, NULL);
    struct sigaction action = {.sa_sigaction = on_crash, .sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; ++i) sigaction(signals[i], &action, NULL);
}

static void silence(void)
{
    const int nowhere = open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3 && nowhere >= 0; ++fd) dup2(nowhere, fd);
}

static _Noreturn void child_run(const process_request *q, int pipe)
{
    static child_state state;
    check_run run = q->run;
    state.run = &run;
    state.pipe = pipe;
    child = &state;
    setpgid(0, 0);
    silence();
    handlers_set();
    const struct rlimit cpu = {q->cpu_s, q->cpu_s + 2}, core = {0, 0};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &core);
    const char *fault = run_open(&run, q->id);
    if (fault) {
        snprintf(run.message, sizeof run.message, "%s", fault);
        send_text(run.message);
        _exit(CODE_FAIL);
    }
    const check_verdict verdict = q->task(&run);
    if (verdict != CHECK_PASS) send_text(run.message);
    _exit(verdict == CHECK_PASS ? CODE_PASS : verdict == CHECK_SKIP ? CODE_SKIP : CODE_FAIL);
}

// ---- In the parent ----

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

// Up to the closing of the pipe or the deadline. Returns 1 when the deadline came first.
static int read_until(int fd, double deadline, char *text, size_t size)
{
    size_t used = 0;
    char spare[256];
    for (;;) {
        const double left = deadline - now_s();
        struct pollfd p = {fd, POLLIN, 0};
        text[used] = 0;
        if (left <= 0) return 1;
        if (poll(&p, 1, left > 1 ? 1000 : (int)(left * 1000) + 1) <= 0) continue;
        char *to = used + 1 < size ? text + used : spare;
        const ssize_t got = read(fd, to, to == spare ? sizeof spare : size - 1 - used);
        if (got <= 0) return 0;
        if (to != spare) used += (size_t)got;
    }
}

// A process that closed its pipe need not end.
static int ended_before(pid_t pid, double deadline, int *status)
{
    const struct timespec nap = {0, 2000000};
    do {
        if (waitpid(pid, status, WNOHANG) == pid) return 1;
        nanosleep(&nap, NULL);
    } while (now_s() < deadline);
    return 0;
}

static void judge(int status, int is_late, const process_request *q, process_result *out)
{
    const size_t used = strlen(out->message), left = sizeof out->message - used;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    out->verdict = !is_late && code == CODE_PASS ? CHECK_PASS : !is_late && code == CODE_SKIP ? CHECK_SKIP : CHECK_FAIL;
    if (is_late) snprintf(out->message, sizeof out->message, "it did not end within %u s", q->wall_s);
    else if (WIFSIGNALED(status))
        snprintf(out->message + used, left, "%sit was ended by signal %d (%s)", used ? "; " : "", WTERMSIG(status), strsignal(WTERMSIG(status)));
    else if (code != CODE_PASS && code != CODE_SKIP && !used)
        snprintf(out->message, sizeof out->message, "its process ended with code %d before the check did", code);
}

void process_run(const process_request *q, process_result *out)
{
    int ends[2], status = 0;
    *out = (process_result){.verdict = CHECK_FAIL};
    const double start = now_s();
    fflush(NULL);
    if (pipe2(ends, O_CLOEXEC) != 0) {
        snprintf(out->message, sizeof out->message, "no pipe for its process; close some files and try again");
        return;
    }
    const pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        child_run(q, ends[1]);
    }
    close(ends[1]);
    if (pid < 0) {
        snprintf(out->message, sizeof out->message, "no process for it; end some others and try again");
    } else {
        const int is_late = read_until(ends[0], start + q->wall_s, out->message, sizeof out->message);
        const int is_hung = is_late || !ended_before(pid, start + q->wall_s, &status);
        if (is_hung) {
            kill(pid, SIGKILL);
            while (waitpid(pid, &status, 0) < 0) continue;
        }
        kill(-pid, SIGKILL); // what it started: the group is its own
        judge(status, is_hung, q, out);
    }
    close(ends[0]);
    out->seconds = now_s() - start;
}
