// The services that the host lends to plugins (cull_host), and where their log lines go.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_HOST_H
#define PORTCULLIS_HOST_HOST_H

#include "memory.h"
#include "report.h"

#include <portcullis/culler.h>

// Lives as long as any culler made with it. `log` receives the plugins' lines, from whatever thread they come: see report.h.
typedef struct host_services {
    cull_host host; // what plugins get; host.user points back here
    const allocator *memory;
    report *log;
    cull_costs costs; // that plugins are lent
} host_services;

// With fixed costs, the same on every machine.
void host_services_fill(host_services *s, const allocator *memory, report *log);
// [main, no view being culled] Other costs from now on, for all that were lent the old ones.
void host_costs_set(const host_services *s, const cull_costs *costs);

#endif
