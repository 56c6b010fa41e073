// The window's keys and mouse, gathered between two frames.
// SPDX-License-Identifier: MIT
#include "gl.h"

#include <GLFW/glfw3.h>
#include <string.h>

static int key_of(int glfw_key)
{
    if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z) return 'a' + (glfw_key - GLFW_KEY_A);
    switch (glfw_key) {
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: return '+';
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: return '-';
    case GLFW_KEY_LEFT: return KEY_LEFT;
    case GLFW_KEY_RIGHT: return KEY_RIGHT;
    case GLFW_KEY_UP: return KEY_UP;
    case GLFW_KEY_DOWN: return KEY_DOWN;
    case GLFW_KEY_ESCAPE: return KEY_ESCAPE;
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT: return KEY_SHIFT;
    default: return 0;
    }
}

static void on_key(GLFWwindow *window, int glfw_key, int code, int action, int mods)
{
    (void)code;
    (void)mods;
    renderer *g = glfwGetWindowUserPointer(window);
    const int key = key_of(glfw_key);
    if (key == 0 || action == GLFW_REPEAT) return;
    g->input.held[key] = action == GLFW_PRESS;
    if (action == GLFW_PRESS && g->input.pressed_count < WINDOW_PRESSES_MOST) g->input.pressed[g->input.pressed_count++] = (char)key;
}

static void on_focus(GLFWwindow *window, int has_focus)
{
    renderer *g = glfwGetWindowUserPointer(window);
    if (!has_focus) memset(g->input.held, 0, sizeof g->input.held); // their release goes to another window
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    (void)mods;
    renderer *g = glfwGetWindowUserPointer(window);
    if (button == GLFW_MOUSE_BUTTON_LEFT) g->mouse_is_held = action == GLFW_PRESS;
}

static void on_mouse(GLFWwindow *window, double x, double y)
{
    renderer *g = glfwGetWindowUserPointer(window);
    if (g->mouse_is_held) {
        g->input.drag_px[0] += x - g->mouse_px[0];
        g->input.drag_px[1] += g->mouse_px[1] - y;
    }
    g->mouse_px[0] = x;
    g->mouse_px[1] = y;
}

void window_listen(renderer *g)
{
    glfwSetWindowUserPointer(g->window, g);
    glfwSetKeyCallback(g->window, on_key);
    glfwSetWindowFocusCallback(g->window, on_focus);
    glfwSetMouseButtonCallback(g->window, on_button);
    glfwSetCursorPosCallback(g->window, on_mouse);
}

void renderer_window_input(renderer *g, window_input *out)
{
    *out = (window_input){0};
    if (!g->window) return;
    int width, height;
    glfwGetFramebufferSize(g->window, &width, &height);
    g->input.width_px = (uint32_t)width;
    g->input.height_px = (uint32_t)height;
    *out = g->input;
    g->input.pressed_count = 0;
    g->input.drag_px[0] = g->input.drag_px[1] = 0;
}
