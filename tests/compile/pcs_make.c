// Makes a scene file of any scene that can be imported, without compiling it: for tests only, as no other command than
// `portcullis compile` writes one. usage: pcs_make SCENE OUT.pcs
// SPDX-License-Identifier: MIT
#include "host/compile/pcs_write.h"
#include "host/import/import.h"

#include <stdio.h>

int main(int argc, char **argv)
{
    const allocator *memory = allocator_heap();
    const import_options options = {DOORS_OPEN};
    report r = report_to_stderr();
    scene *s = NULL;
    if (argc != 3) {
        fprintf(stderr, "usage: pcs_make SCENE OUT.pcs\n");
        return 2;
    }
    result done = import_scene(argv[1], &options, memory, &r, &s);
    if (done == RESULT_OK) done = pcs_write(&(pcs_request){.scene = s}, argv[2], memory, &r);
    scene_free(s, memory);
    return done == RESULT_OK ? 0 : 2;
}
