// Where `portcullis auto` writes its choice: the same scene with a chain at each zone.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_AUTO_WRITE_H
#define PORTCULLIS_HOST_APP_AUTO_WRITE_H

#include "app.h"

// Before long work: whether that file can hold that scene's chains. OUT.pcs any scene's; OUT.json those of a JSON scene whose zones
// are all its own, beside it where it names files, and of plain geometry, whose one zone it makes.
result auto_can_write(app *a, const char *scene_path, const char *out_path);
// The app's scene has its zones' chains set.
result auto_write(app *a, const char *scene_path, const char *out_path);

#endif
