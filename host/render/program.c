// Programs: one text for each stage, variants by defines, compiled on first use.
// SPDX-License-Identifier: MIT
#include "gl.h"

#include "shader_text.h"

#include <stdio.h>

typedef struct program_text {
    const char *vertex, *fragment, *define;
    uint32_t is_surface; // of the scene: surface.glsl stands before its fragment stage
} program_text;

static program_text text_of(program_kind kind)
{
    switch (kind) {
    case PROGRAM_ID: return (program_text){scene_vert, id_frag, "#define FAR_DEPTH\n", 1};
    case PROGRAM_SEE_THROUGH: return (program_text){scene_vert, see_through_frag, "", 1};
    case PROGRAM_SHADED: return (program_text){scene_vert, frame_frag, "#define SHADED\n", 1};
    case PROGRAM_ITEMS: return (program_text){scene_vert, frame_frag, "#define ITEMS\n", 1};
    case PROGRAM_ZONES: return (program_text){scene_vert, frame_frag, "#define ZONES\n#define EYE_POSITION\n", 1};
    case PROGRAM_DEPTH: return (program_text){scene_vert, frame_frag, "#define DEPTH\n#define EYE_POSITION\n", 1};
    case PROGRAM_OVERDRAW: return (program_text){scene_vert, frame_frag, "#define OVERDRAW\n", 1};
    case PROGRAM_BOXES: return (program_text){boxes_vert, boxes_frag, "", 0};
    case PROGRAM_PICTURE: return (program_text){picture_vert, picture_frag, "", 0};
    case PROGRAM_OUTLINE: return (program_text){outline_vert, "void main() {}\n", "", 0};
    case PROGRAM_OVERLAY: return (program_text){overlay_vert, overlay_frag, "", 0};
    default: return (program_text){heat_vert, heat_frag, "", 0};
    }
}

static GLuint compile(renderer *g, GLenum stage, const char *const *parts, GLsizei count)
{
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, count, parts, NULL);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return shader;
    char log[512] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    report_error(&g->sink, NULL, 0, "the driver refuses a shader: %s; try another driver", log);
    glDeleteShader(shader);
    return 0;
}

static GLuint link_program(renderer *g, GLuint vertex, GLuint fragment)
{
    const GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good) return program;
    char log[512] = "";
    glGetProgramInfoLog(program, sizeof log, NULL, log);
    report_error(&g->sink, NULL, 0, "the driver refuses a program: %s; try another driver", log);
    glDeleteProgram(program);
    return 0;
}

static GLuint build(renderer *g, program_kind kind, uint32_t variant)
{
    const program_text text = text_of(kind);
    char head[704];
    snprintf(head, sizeof head,
             "#version 450 core\n#define WORD_TRANSLUCENT %uu\n#define WORD_CUT_OUT %uu\n#define WORD_SKY %uu\n#define WORD_TWO_SIDED %uu\n%s%s%s%s%s%s%s%s%s", (unsigned)WORD_TRANSLUCENT,
             (unsigned)WORD_CUT_OUT, (unsigned)WORD_SKY, (unsigned)WORD_TWO_SIDED, text.define, variant & VARIANT_CUT_OUT ? "#define CUT_OUT\n" : "",
             variant & VARIANT_TRANSLUCENT ? "#define TRANSLUCENT\n" : "", variant & VARIANT_SIDES ? "#define SIDES\n" : "",
             variant & VARIANT_CLIP ? "#define CLIP\n" : "", variant & VARIANT_KEEP_DEPTH ? "#define KEEP_DEPTH\n" : "",
             variant & VARIANT_MOVERS ? "#define MOVERS\n" : "", variant & VARIANT_LINEAR ? "#define LINEAR\n" : "",
             kind == PROGRAM_SHADED && variant & VARIANT_FLAT ? "#define FLAT\n#define EYE_POSITION\n" : "");
    const char *const light = kind == PROGRAM_SHADED ? light_glsl : "";
    const char *const vertex_parts[] = {head, light, text.vertex};
    const char *const fragment_parts[] = {head, light, text.is_surface ? surface_glsl : "", text.fragment};
    const GLuint vertex = compile(g, GL_VERTEX_SHADER, vertex_parts, 3);
    const GLuint fragment = vertex ? compile(g, GL_FRAGMENT_SHADER, fragment_parts, 4) : 0;
    const GLuint program = fragment ? link_program(g, vertex, fragment) : 0;
    glDeleteShader(vertex); // 0 is fine
    glDeleteShader(fragment);
    return program;
}

GLuint program_find(renderer *g, program_kind kind, uint32_t variant)
{
    GLuint *place = &g->programs[kind][variant];
    if (*place) return *place;
    *place = build(g, kind, variant);
    if (!*place) g->errors++;
    return *place;
}

void programs_close(renderer *g)
{
    for (int kind = 0; kind < PROGRAM_KINDS; ++kind)
        for (uint32_t variant = 0; variant < VARIANTS; ++variant) {
            glDeleteProgram(g->programs[kind][variant]);
            g->programs[kind][variant] = 0;
        }
}
