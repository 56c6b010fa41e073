// Contexts: EGL without a surface, or a GLFW window; errors of GL caught and told.
// SPDX-License-Identifier: MIT
// libepoxy aborts the process when a library or an entry point is missing: each is asked for before it is called.
#include "gl.h"

#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

static const char *const DRIVER_ADVICE =
    "install a driver (Debian: apt-get install libgl1-mesa-dri libegl1 libgl1; it brings a software renderer)";

static result no_gl(report *r, const char *what)
{
    report_error(r, NULL, 0, "no OpenGL 4.5: %s; %s", what, DRIVER_ADVICE);
    return RESULT_NO_GL;
}

static int library_exists(const char *name)
{
    void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library) dlclose(library); // epoxy opens it again, by the same name
    return library != NULL;
}

static int has_word(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = words; at && (at = strstr(at, word)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0)) return 1;
    return 0;
}

static EGLDisplay headless_display(void)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLint major, minor;
    if (has_word(extensions, "EGL_EXT_platform_base") && has_word(extensions, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, &major, &minor)) return display;
    display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, &major, &minor)) return display;
    return EGL_NO_DISPLAY;
}

static result open_headless(renderer *g, report *r)
{
    if (!library_exists("libEGL.so.1")) return no_gl(r, "libEGL.so.1 is not installed");
    g->display = headless_display(); // never terminated: the process shares it with other renderers
    if (g->display == EGL_NO_DISPLAY) return no_gl(r, "EGL finds no display");
    const char *extensions = eglQueryString(g->display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_surfaceless_context")) return no_gl(r, "EGL has no EGL_KHR_surfaceless_context");
    if (!eglBindAPI(EGL_OPENGL_API)) return no_gl(r, "EGL offers no desktop OpenGL");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!eglChooseConfig(g->display, wanted, &config, 1, &count) || count < 1) {
        if (!has_word(extensions, "EGL_KHR_no_config_context")) return no_gl(r, "EGL has no configuration for OpenGL");
        config = NULL; // EGL_NO_CONFIG_KHR
    }
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifndef NDEBUG
        EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE,
#endif
        EGL_NONE};
    g->context = eglCreateContext(g->display, config, EGL_NO_CONTEXT, attributes);
    if (g->context == EGL_NO_CONTEXT) return no_gl(r, "the driver gives no 4.5 core context");
    if (!eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, g->context)) return no_gl(r, "the context can't be made current");
    return RESULT_OK;
}

static result open_window(renderer *g, const renderer_options *o, report *r)
{
    const char *why = NULL;
    if (!library_exists("libEGL.so.1")) return no_gl(r, "libEGL.so.1 is not installed");
    if (!glfwInit()) {
        glfwGetError(&why);
        report_error(r, NULL, 0, "no window: %s; set DISPLAY, or render without a window", why ? why : "GLFW does not start");
        return RESULT_NO_GL;
    }
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); // pictures are drawn elsewhere and copied in
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
#ifndef NDEBUG
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
    g->window = glfwCreateWindow((int)o->width_px, (int)o->height_px, o->title ? o->title : "Portcullis", NULL, NULL);
    if (!g->window) {
        glfwGetError(&why);
        no_gl(r, why ? why : "GLFW opens no window");
        glfwTerminate();
        return RESULT_NO_GL;
    }
    window_listen(g);
    glfwMakeContextCurrent(g->window);
    glfwSwapInterval(1);
    return RESULT_OK;
}

static void APIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar *text, const void *user)
{
    (void)source;
    (void)id;
    (void)severity;
    (void)length;
    renderer *g = (renderer *)(uintptr_t)user; // GL hands back as const what was given to it writable
    if (type != GL_DEBUG_TYPE_ERROR) return;
    g->errors++;
    report_error(&g->sink, NULL, 0, "GL: %s; please report this as a bug", text);
}

static const char *error_name(GLenum error)
{
    switch (error) {
    case GL_INVALID_ENUM: return "invalid enum";
    case GL_INVALID_VALUE: return "invalid value";
    case GL_INVALID_OPERATION: return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY: return "out of memory";
    default: return "unknown error";
    }
}

result gl_check(renderer *g, report *r, const char *doing)
{
    enum { FLAGS_MOST = 16 }; // a lost context answers errors without end
    result found = RESULT_OK;
    for (int i = 0; i < FLAGS_MOST; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        if (!g->has_debug) {
            g->errors++;
            report_error(r ? r : &g->sink, NULL, 0, "GL: %s while %s; try a smaller picture or scene, or another driver", error_name(error), doing);
        }
        found = RESULT_NO_GL;
    }
    return found;
}

static result prepare(renderer *g, report *r)
{
    if (epoxy_gl_version() < 45) return no_gl(r, "the context is older");
    GLint flags = 0, size = 0, viewport[2] = {0, 0};
    glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
    if (flags & GL_CONTEXT_FLAG_DEBUG_BIT) {
        g->has_debug = 1;
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_message, g);
    }
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &size);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    g->size_most_px = (uint32_t)(size < viewport[0] ? size : viewport[0]);
    if ((uint32_t)viewport[1] < g->size_most_px) g->size_most_px = (uint32_t)viewport[1];
    snprintf(g->name, sizeof g->name, "%s, OpenGL %s", (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepthf(0); // reversed z: 0 is infinitely far. DESIGN.md's "depth LESS" is meant in distance
    glDisable(GL_DITHER);
    glDisable(GL_MULTISAMPLE);
    glFrontFace(GL_CCW);
    glCullFace(GL_BACK);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION); // upload.c turns triangles so that the last vertex is theirs alone
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    state_forget(g);
    return gl_check(g, r, "setting up");
}

result renderer_open(const renderer_options *o, const allocator *memory, report *r, renderer **out)
{
    renderer *g = memory_alloc_zeroed(memory, 1, sizeof *g);
    if (!g) return report_no_memory(r, NULL);
    g->memory = memory;
    g->sink = *r;
    g->display = EGL_NO_DISPLAY;
    g->context = EGL_NO_CONTEXT;
    g->tests.by_driver = 1;
    g->pictures.options.bytes_most = 256u << 20;
    result done = o && o->target == RENDERER_WINDOW ? open_window(g, o, r) : open_headless(g, r);
    if (done == RESULT_OK) done = prepare(g, r);
    if (done == RESULT_OK) done = boxes_open(g, r);
    if (done == RESULT_OK) done = overlay_open(g, r);
    if (done != RESULT_OK) {
        renderer_close(g);
        return done;
    }
    *out = g;
    return RESULT_OK;
}

static void make_current(renderer *g)
{
    if (g->window) glfwMakeContextCurrent(g->window);
    else if (g->context != EGL_NO_CONTEXT) eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, g->context);
}

void renderer_close(renderer *g)
{
    if (!g) return;
    if (g->window || g->context != EGL_NO_CONTEXT) {
        make_current(g);
        pictures_close(g);
        tests_close(g);
        scene_release(g);
        boxes_close(g);
        overlay_close(g);
        targets_close(g);
        programs_close(g);
    }
    if (g->window) {
        glfwDestroyWindow(g->window);
        glfwTerminate();
    }
    if (g->context != EGL_NO_CONTEXT) {
        eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(g->display, g->context);
    }
    memory_free(g->memory, g, 1, sizeof *g);
}

const char *renderer_name(const renderer *g)
{
    return g->name;
}

uint32_t renderer_errors(const renderer *g)
{
    return g->errors;
}

int renderer_window_is_open(renderer *g)
{
    if (!g->window) return 0;
    glfwPollEvents();
    return !glfwWindowShouldClose(g->window);
}

void renderer_present(renderer *g)
{
    if (!g->window || !g->frame.target) return;
    const target *t = g->frame.target;
    int width, height;
    glfwGetFramebufferSize(g->window, &width, &height);
    const int same = (uint32_t)width == t->width_px && (uint32_t)height == t->height_px;
    glBlitNamedFramebuffer(t->framebuffer, 0, 0, 0, (GLint)t->width_px, (GLint)t->height_px, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                           same ? GL_NEAREST : GL_LINEAR);
    glfwSwapBuffers(g->window);
    gl_check(g, NULL, "presenting");
}
