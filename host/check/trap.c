// Traps in a library's table of imported functions: see trap.h. ELF-64 as in the System V ABI; seccomp(2) as in Linux.
// SPDX-License-Identifier: MIT
// Invariant: between trap_set and trap_clear the library runs no other code of the C library than what it calls through itself.
#define _GNU_SOURCE
#include "trap.h"
#include "process.h"

#include <elf.h>
#include <errno.h>
#include <link.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { PAGE_BYTES = 4096 };

#define FORBIDDEN(X) \
    X(malloc) X(calloc) X(realloc) X(free) X(reallocarray) X(aligned_alloc) X(posix_memalign) X(memalign) X(strdup) X(mmap) X(munmap) \
    X(brk) X(sbrk) X(_Znwm) X(_Znam) X(_ZdlPv) X(_ZdlPvm) X(_ZdaPv) X(open) X(open64) X(openat) X(fopen) X(fopen64) X(fclose) X(read) \
    X(fread) X(pread) X(write) X(fwrite) X(pwrite) X(stat) X(lseek) X(printf) X(puts) X(putchar) X(fprintf) X(fputs) X(fputc) X(vfprintf) \
    X(perror) X(fflush) X(__printf_chk) X(__fprintf_chk) X(getenv) X(system) X(fork) X(socket) X(send) X(recv) X(connect) X(nanosleep) \
    X(clock_nanosleep) X(usleep) X(sleep) X(sched_yield) X(poll) X(select) X(pthread_create) X(pthread_join) X(pthread_cond_wait) \
    X(sem_wait) X(dlopen) X(exit) X(_exit) X(abort) X(syscall)

#define TRAP_FUNCTION(name)                                                                                                                           \
    static _Noreturn void trap_##name(void)                                                                                                           \
    {                                                                                                                                                 \
        process_fail_now("it called " #name " in a step, which allocates nothing, does no input or output and waits for nothing");                     \
    }
FORBIDDEN(TRAP_FUNCTION)

typedef struct forbidden { const char *name; void (*trap)(void); } forbidden;
#define TRAP_ENTRY(name) {#name, trap_##name},
static const forbidden table[] = {FORBIDDEN(TRAP_ENTRY)};

static void *address_of(void (*f)(void)) // C has no cast between the two; POSIX has
{
    void *address;
    memcpy(&address, &f, sizeof address);
    return address;
}

typedef struct library { const void *entry; struct dl_phdr_info info; int found; } library;

static int find_library(struct dl_phdr_info *info, size_t size, void *user)
{
    library *l = user;
    (void)size;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const ElfW(Phdr) *p = &info->dlpi_phdr[i];
        const ElfW(Addr) begin = info->dlpi_addr + p->p_vaddr, at = (ElfW(Addr))l->entry;
        if (p->p_type != PT_LOAD || at < begin || at >= begin + p->p_memsz) continue;
        l->info = *info;
        return l->found = 1;
    }
    return 0;
}

typedef struct dynamic { const ElfW(Sym) *symbols; const char *names; const ElfW(Rela) *tables[2]; size_t sizes[2]; } dynamic;

// glibc has relocated these pointers, other C libraries have not.
static const void *pointer_of(const library *l, ElfW(Addr) value)
{
    return (const void *)(value < l->info.dlpi_addr ? value + l->info.dlpi_addr : value);
}

static int dynamic_read(const library *l, dynamic *out)
{
    const ElfW(Dyn) *d = NULL;
    *out = (dynamic){0};
    for (int i = 0; i < l->info.dlpi_phnum; ++i)
        if (l->info.dlpi_phdr[i].p_type == PT_DYNAMIC) d = (const ElfW(Dyn) *)(l->info.dlpi_addr + l->info.dlpi_phdr[i].p_vaddr);
    for (; d && d->d_tag != DT_NULL; ++d) {
        if (d->d_tag == DT_SYMTAB) out->symbols = pointer_of(l, d->d_un.d_ptr);
        if (d->d_tag == DT_STRTAB) out->names = pointer_of(l, d->d_un.d_ptr);
        if (d->d_tag == DT_JMPREL) out->tables[0] = pointer_of(l, d->d_un.d_ptr);
        if (d->d_tag == DT_PLTRELSZ) out->sizes[0] = d->d_un.d_val;
        if (d->d_tag == DT_RELA) out->tables[1] = pointer_of(l, d->d_un.d_ptr);
        if (d->d_tag == DT_RELASZ) out->sizes[1] = d->d_un.d_val;
    }
    return out->symbols && out->names;
}

static void slot_add(trap *t, const library *l, const char *name, ElfW(Addr) offset)
{
    for (size_t i = 0; i < sizeof table / sizeof *table && t->slot_count < TRAP_SLOTS_MOST; ++i) {
        if (strcmp(table[i].name, name) != 0) continue;
        void **at = (void **)(l->info.dlpi_addr + offset);
        t->slots[t->slot_count++] = (trap_slot){at, *at, address_of(table[i].trap)};
    }
}

static void segments_find(trap *t, const library *l)
{
    ElfW(Addr) relro_end = 0; // in front of it the segment is read-only already
    for (int i = 0; i < l->info.dlpi_phnum; ++i)
        if (l->info.dlpi_phdr[i].p_type == PT_GNU_RELRO) relro_end = l->info.dlpi_phdr[i].p_vaddr + l->info.dlpi_phdr[i].p_memsz;
    for (int i = 0; i < l->info.dlpi_phnum && t->segment_count < TRAP_SEGMENTS_MOST; ++i) {
        const ElfW(Phdr) *p = &l->info.dlpi_phdr[i];
        if (p->p_type != PT_LOAD || !(p->p_flags & PF_W)) continue;
        ElfW(Addr) begin = p->p_vaddr, end = p->p_vaddr + p->p_memsz;
        if (relro_end > begin && relro_end <= end) begin = relro_end;
        begin = (l->info.dlpi_addr + begin + PAGE_BYTES - 1) / PAGE_BYTES * PAGE_BYTES;
        end = (l->info.dlpi_addr + end + PAGE_BYTES - 1) / PAGE_BYTES * PAGE_BYTES;
        if (begin < end) t->writable[t->segment_count++] = (trap_segment){(char *)begin, end - begin};
    }
}

int trap_find(trap *t, const void *entry)
{
    library l = {.entry = entry};
    dynamic d;
    *t = (trap){.slot_count = 0};
    dl_iterate_phdr(find_library, &l);
    if (!l.found || !dynamic_read(&l, &d)) return 0;
    for (int k = 0; k < 2; ++k)
        for (size_t i = 0; d.tables[k] && i < d.sizes[k] / sizeof(ElfW(Rela)); ++i) {
            const ElfW(Rela) *rela = &d.tables[k][i];
            const uint64_t symbol = ELF64_R_SYM(rela->r_info);
            if (symbol && rela->r_addend == 0) slot_add(t, &l, d.names + d.symbols[symbol].st_name, rela->r_offset);
        }
    segments_find(t, &l);
    return 1;
}

static void slot_write(const trap_slot *s, void *value)
{
    char *page = (char *)((uintptr_t)s->at / PAGE_BYTES * PAGE_BYTES);
    if (mprotect(page, PAGE_BYTES, PROT_READ | PROT_WRITE) == 0) *s->at = value;
}

void trap_set(const trap *t)
{
    for (uint32_t i = 0; i < t->slot_count; ++i) slot_write(&t->slots[i], t->slots[i].trap);
}

void trap_clear(const trap *t)
{
    for (uint32_t i = 0; i < t->slot_count; ++i) slot_write(&t->slots[i], t->slots[i].was);
}

void trap_seal_data(const trap *t)
{
    for (uint32_t i = 0; i < t->segment_count; ++i) {
        process_name_region(t->writable[i].begin, t->writable[i].size, "data of the library itself, which all its cullers share");
        mprotect(t->writable[i].begin, t->writable[i].size, PROT_READ);
    }
}

void trap_release_data(const trap *t)
{
    for (uint32_t i = 0; i < t->segment_count; ++i) mprotect(t->writable[i].begin, t->writable[i].size, PROT_READ | PROT_WRITE);
}

// ---- The kernel's part ----

static void on_call(int number, siginfo_t *info, void *context)
{
    char text[96];
    (void)number;
    (void)context;
    snprintf(text, sizeof text, "it made system call %d in a step, which does no input or output and waits for nothing", info->si_syscall);
    process_fail_now(text);
}

int trap_kernel(void)
{
    static const long good[] = {SYS_write, SYS_exit_group, SYS_exit, SYS_rt_sigreturn};
    enum { GOOD = sizeof good / sizeof *good };
    struct sock_filter code[GOOD + 3];
    uint32_t at = 0;
    code[at++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (uint32_t i = 0; i < GOOD; ++i) code[at++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)good[i], (uint8_t)(GOOD - i), 0);
    code[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    code[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    const struct sock_fprog program = {(unsigned short)at, code};
    struct sigaction action = {.sa_sigaction = on_call, .sa_flags = SA_SIGINFO | SA_ONSTACK};
    sigemptyset(&action.sa_mask);
    sigaction(SIGSYS, &action, NULL);
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}
