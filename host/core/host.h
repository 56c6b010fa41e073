// The services that the host lends to plugins (cull_host), and where their log lines go.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_HOST_H
#define PORTCULLIS_HOST_HOST_H

#include "memory.h"
#include "report.h"

#include <portcullis/culler.h>

// Lives as long as any culler made with it. `log` receives the plugins' lines; its counters are the only thing that
// changes after host_make, so logging is serialised by the caller's report.
typedef struct host_services {
    cull_host host; // what plugins get; host.user points back here
    const allocator *memory;
    report *log;
} host_services;

void host_services_fill(host_services *s, const allocator *memory, report *log);

#endif
