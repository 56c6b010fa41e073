// Tests of chains: the text, who may stand where, options, what is lent, and cullers that fail before the first frame.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct parsed {
    failing_allocator memory;
    report_lines lines;
    arena texts;
    chain_spec spec;
} parsed;

static int set_up(void **state)
{
    parsed *p = *state = calloc(1, sizeof(parsed));
    if (!p) return 1;
    failing_allocator_init(&p->memory, 0);
    report_lines_init(&p->lines);
    p->texts = arena_make(&p->memory.memory);
    return 0;
}

static int tear_down(void **state)
{
    parsed *p = *state;
    arena_free(&p->texts);
    const int clean = failing_allocator_is_clean(&p->memory);
    free(p);
    return clean ? 0 : 1;
}

static result parse(parsed *p, const char *text)
{
    report_lines_init(&p->lines);
    return chain_parse(text, &p->texts, &p->lines.report, &p->spec);
}

static void a_chain_s_text_is_split_into_stages_and_options(void **state)
{
    parsed *p = *state;
    char text[] = "octree[leaf=64,kind=quad+x]+bsp+occlusion[method=a=b]";
    assert_int_equal(parse(p, text), RESULT_OK);
    memset(text, 'x', sizeof text - 1); // the texts are copies
    const chain_spec *s = &p->spec;
    assert_string_equal(s->text, "octree[leaf=64,kind=quad+x]+bsp+occlusion[method=a=b]");
    assert_int_equal(s->stage_count, 3);
    assert_string_equal(s->stages[0].id, "octree");
    assert_int_equal(s->stages[0].option_count, 2);
    assert_string_equal(s->stages[0].options[0].key, "leaf");
    assert_string_equal(s->stages[0].options[0].value, "64");
    assert_string_equal(s->stages[0].options[1].value, "quad+x");
    assert_string_equal(s->stages[1].id, "bsp");
    assert_int_equal(s->stages[1].option_count, 0);
    assert_string_equal(s->stages[2].options[0].value, "a=b");
    assert_int_equal(parse(p, "a+b+c+d+e+f+g+h"), RESULT_OK);
    assert_int_equal(p->spec.stage_count, 8);
}

static void a_fault_in_a_chain_s_text_is_told_with_its_place(void **state)
{
    parsed *p = *state;
    static const struct { const char *text; int place; const char *what; } cases[] = {
        {"", 1, "name is missing"}, {"+", 1, "name is missing"}, {"a+", 3, "name is missing"}, {"a++b", 3, "name is missing"}, {"[x=1]", 1, "name is missing"},
        {"a]", 2, "'+' or the end"}, {"a=b", 2, "'+' or the end"}, {"a,b", 2, "'+' or the end"}, {"a[x=1]b", 7, "'+' or the end"}, {"a[x=1][y=2]", 7, "'+' or the end"},
        {"a[", 3, "option's name is missing"}, {"a[]", 3, "option's name is missing"}, {"a[x=1,]", 7, "option's name is missing"}, {"a[=1]", 3, "option's name is missing"},
        {"a[x]", 4, "needs '='"}, {"a[x", 4, "needs '='"}, {"a[x+b", 4, "needs '='"}, {"a[x=]", 5, "value is missing"}, {"a[x=", 5, "value is missing"}, {"a[x=,y=1]", 5, "value is missing"},
        {"a[x=1", 6, "']' is missing"}, {"a[x=1[", 6, "']' is missing"}, {"a[x=1,x=2]", 10, "stands twice"}, {"a+b+c+d+e+f+g+h+i", 17, "over 8 cullers"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char place[64];
        assert_int_equal(parse(p, cases[i].text), RESULT_BAD_INPUT);
        snprintf(place, sizeof place, "at character %d: ", cases[i].place);
        assert_true(report_lines_is_one_with(&p->lines, place));
        assert_true(report_lines_is_one_with(&p->lines, cases[i].what));
    }
}

static void a_chain_of_too_many_options_or_characters_is_refused(void **state)
{
    parsed *p = *state;
    static char text[6000];
    int length = snprintf(text, sizeof text, "a[o0=0");
    for (int i = 1; i < CHAIN_OPTIONS_MOST; ++i) length += snprintf(text + length, sizeof text - (size_t)length, ",o%d=%d", i, i);
    snprintf(text + length, sizeof text - (size_t)length, "]");
    assert_int_equal(parse(p, text), RESULT_OK);
    assert_int_equal(p->spec.stages[0].option_count, CHAIN_OPTIONS_MOST);
    snprintf(text + length, sizeof text - (size_t)length, ",more=1]");
    assert_int_equal(parse(p, text), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&p->lines, "too many options"));
    memset(text, 'a', sizeof text - 1);
    assert_int_equal(parse(p, text), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&p->lines, "over 4096 characters"));
}

// ---- Building ----

static const session_request small = {.boxes = {.items = 16, .movers = 3, .seed = 1}};

// Opens the chain, keeps its one line in `line`, closes it again.
static result open_and_close(const char *chain, char line[REPORT_LINE_BYTES])
{
    static session s;
    session_request q = small;
    q.chain = chain;
    const result done = session_open(&s, &q);
    snprintf(line, REPORT_LINE_BYTES, "%s", report_lines_only(&s.lines));
    session_close(&s);
    return done;
}

static void assert_refused(const char *chain, const char *part)
{
    char line[REPORT_LINE_BYTES];
    const result done = open_and_close(chain, line);
    if (done != RESULT_BAD_INPUT || !strstr(line, part)) fail_msg("%s: result %d, '%s' does not say '%s'", chain, (int)done, line, part);
}

static void a_chain_that_cannot_serve_is_refused_and_says_why(void **state)
{
    (void)state;
    assert_refused("testfilter", "'testfilter' cannot stand first");
    assert_refused("testcross", "'testcross' cannot stand first");
    assert_refused("none+brute", "'brute' can only stand first");
    assert_refused("none+testcross+testcross-too", "'testcross-too' is the second crosser");
    assert_refused("none+testcross+testfilter+testcross", "'testcross' is the second crosser");
    assert_refused("none+missing", "no culler 'missing'; found: none, brute, flood, test");
    assert_refused("testpicture+testbad", "cullers 'testpicture' and 'testbad' both take pictures");
    assert_refused("testpicture+testfilter+testcross+testbad", "both take pictures");
    assert_refused("none[x=1]", "has no option 'x'; it has: none");
    assert_refused("none+testfilter[keep=all,kept=1]", "'testfilter' has no option 'kept'; it has: keep, movers, pictures, walk");
}

static void a_chain_s_stages_get_the_roles_of_their_places(void **state)
{
    (void)state;
    static session s;
    session_request q = small;
    q.chain = "brute+testcross+testfilter+testbad+testfilter[movers=1]";
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    static const stage_role roles[] = {ROLE_SELECT, ROLE_CROSS, ROLE_FILTER, ROLE_FILTER, ROLE_FILTER};
    assert_int_equal(s.chain->stage_count, 5);
    for (int i = 0; i < 5; ++i) assert_int_equal(s.chain->stages[i].role, roles[i]);
    assert_int_equal(s.chain->promises, 0); // testcross promises nothing
    assert_true(s.chain->uses_renderer);    // testbad may ask
    session_close(&s);
}

static void a_chain_promises_what_all_its_stages_do(void **state)
{
    (void)state;
    static const struct { const char *chain; cull_promises promises; } cases[] = {
        {"none", CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS}, {"testorder", CULL_CONSERVATIVE | CULL_SAMPLED},
        {"none+testbad", CULL_SAMPLED}, {"testorder+testbad", CULL_SAMPLED}, {"testmore", CULL_SAMPLED}, {"none+testfilter", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        static session s;
        session_request q = small;
        q.chain = cases[i].chain;
        assert_int_equal(session_open(&s, &q), RESULT_OK);
        assert_int_equal(s.chain->promises, cases[i].promises);
        session_close(&s);
    }
}

static void the_stages_behind_a_select_are_lent_the_zone_in_its_order(void **state)
{
    (void)state;
    static session s;
    session_request q = small;
    q.chain = "testorder+testfilter";
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    const chain *c = s.chain;
    assert_non_null(c->order);
    for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t item = c->order[i];
        assert_int_equal(item, 15 - i);
        assert_memory_equal(&c->ordered_zone.items[i], &c->zone.items[item], sizeof(cull_item));
        const cull_boxes *to = &c->ordered_zone.boxes, *from = &s.scene->boxes;
        assert_true(to->min_x[i] == from->min_x[item] && to->min_y[i] == from->min_y[item] && to->min_z[i] == from->min_z[item]);
        assert_true(to->max_x[i] == from->max_x[item] && to->max_y[i] == from->max_y[item] && to->max_z[i] == from->max_z[item]);
    }
    for (uint32_t i = 16; i < 16 + CULL_PADDING; ++i) assert_true(c->ordered_zone.boxes.max_z[i] == 0);
    assert_int_equal((uintptr_t)c->ordered_zone.boxes.min_x % 64, 0);
    session_close(&s);
}

static void the_zone_lent_is_the_scene(void **state)
{
    (void)state;
    static session s;
    session_request q = small;
    q.chain = "none";
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    const cull_zone *z = &s.chain->zone;
    assert_null(s.chain->order);
    assert_int_equal(z->item_count, 16);
    assert_int_equal(z->mover_capacity, 3);
    assert_int_equal(z->portal_count, 0);
    assert_ptr_equal(z->positions, s.scene->positions);
    assert_ptr_equal(z->boxes.max_y, s.scene->boxes.max_y);
    for (uint32_t i = 0; i < 16; ++i) {
        assert_int_equal(z->items[i].first_index, s.scene->items[i].first_index);
        assert_int_equal(z->items[i].polygon_count, 6);
        assert_int_equal(z->items[i].flags, CULL_ITEM_BOX);
    }
    session_close(&s);
}

// ---- Cullers that fail before the first frame ----

static void a_culler_that_tells_nonsense_after_build_is_refused_by_name(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"steps_none", "max_steps"}, {"steps_over", "max_steps"}, {"promises_more", "promises more"}, {"order_twice", "no permutation"},
        {"order_wild", "no permutation"}, {"scratch_absurd", "over 4 GiB"}, {"runs_absurd", "over 2^28"}, {"tests_absurd", "over 2^28"},
        {"captures_absurd", "over 2^28"}, {"pictures_absurd", "over 2^28"}, {"slots_absurd", "over 2^28"}, {"captures_without_slots", "without slots"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char chain[128];
        snprintf(chain, sizeof chain, "testbad[fault=%s]", cases[i][0]);
        assert_refused(chain, cases[i][1]);
        assert_refused(chain, "culler 'testbad'");
        snprintf(chain, sizeof chain, "none+testbad[fault=%s]", cases[i][0]);
        if (!strstr(cases[i][0], "order")) assert_refused(chain, cases[i][1]); // a filter's order is not looked at
    }
    assert_refused("none+testbad[fault=walks_nothing]", "walks a hierarchy, and the select has none");
    assert_refused("testorder[hierarchy=0]+testfilter[walk=1]", "walks a hierarchy, and the select has none");
}

static void a_hierarchy_that_is_nonsense_is_refused_by_name(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"no_nodes", "no nodes"}, {"null_nodes", "nodes are not there"}, {"child_before", "do not come after"}, {"child_itself", "do not come after"},
        {"child_past_end", "a child is no node"}, {"child_wraps", "a child is no node"}, {"child_twice", "child of two"}, {"child_lost", "cannot be reached"},
        {"depth", "its depth"}, {"box_nan", "not finite"}, {"box_inside_out", "not finite"}, {"box_small", "does not cover a child"},
        {"list_past_end", "items that are not there"}, {"list_wraps", "items that are not there"}, {"item_lost", "is in no node"}, {"item_twice", "in two runs"},
        {"list_again", "more items than there are"}, {"item_uncovered", "do not cover it"}, {"subtree_past_end", "outside the zone"},
        {"subtree_wraps", "outside the zone"}, {"subtree_short", "not what its nodes list"}, {"subtree_shifted", "not what its nodes list"},
        {"listed_wild", "not in the zone"}, {"listed_lost", "is in no node"}, {"listed_past_end", "items that are not there"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char chain[128];
        snprintf(chain, sizeof chain, "testorder[spoil=%s]+testfilter", cases[i][0]);
        assert_refused(chain, cases[i][1]);
        assert_refused(chain, "culler 'testorder' lends a hierarchy that is nonsense");
    }
}

static void a_hierarchy_that_is_sound_is_lent(void **state)
{
    (void)state;
    static const char *const chains[] = {"testorder+testfilter[walk=1]", "testorder[spoil=listed]+testfilter[walk=1]", "testorder[spoil=listed_twice]+testfilter[walk=1]",
                                         "testorder[spoil=no_subtrees]+testfilter[walk=1]", "testorder[spoil=depth]"}; // the last is lent to nobody
    for (int i = 0; i < 5; ++i) {
        static session s;
        session_request q = small;
        q.chain = chains[i];
        assert_int_equal(session_open(&s, &q), RESULT_OK);
        assert_int_equal(s.chain->hierarchy != NULL, i < 4);
        session_close(&s);
    }
}

static void a_culler_that_fails_is_named_and_nothing_of_it_is_used(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"create_option", "'testbad' refused an option"}, {"no_such_fault", "'testbad' refused an option"}, {"create_zone", "'testbad' could not create"},
        {"create_blob", "'testbad' refused a baked index"}, {"create_odd", "(result 42)"}, {"create_null", "'testbad' could not create"},
        {"create_leaves", "'testbad' could not create"}, {"build_option", "'testbad' refused an option"}, {"build_zone", "'testbad' could not build"},
        {"build_blob", "'testbad' refused a baked index"}, {"build_odd", "(result 42)"}, {"open_zone", "'testbad' could not open"},
        {"open_odd", "(result 42)"}, {"open_null", "'testbad' could not open"}, {"open_leaves", "'testbad' could not open"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char chain[128];
        snprintf(chain, sizeof chain, "testbad[fault=%s]+testfilter", cases[i][0]);
        assert_refused(chain, cases[i][1]);
        snprintf(chain, sizeof chain, "none+testfilter+testbad[fault=%s]", cases[i][0]);
        assert_refused(chain, cases[i][1]);
    }
}

static void a_culler_without_memory_is_told_as_such(void **state)
{
    (void)state;
    static const char *const faults[] = {"create_memory", "build_memory", "open_memory"};
    for (int i = 0; i < 3; ++i) {
        char chain[64], line[REPORT_LINE_BYTES];
        snprintf(chain, sizeof chain, "testbad[fault=%s]", faults[i]);
        assert_int_equal(open_and_close(chain, line), RESULT_NO_MEMORY);
        assert_non_null(strstr(line, "out of memory"));
    }
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_chain_s_text_is_split_into_stages_and_options),
        TEST(a_fault_in_a_chain_s_text_is_told_with_its_place),
        TEST(a_chain_of_too_many_options_or_characters_is_refused),
        cmocka_unit_test(a_chain_that_cannot_serve_is_refused_and_says_why),
        cmocka_unit_test(a_chain_s_stages_get_the_roles_of_their_places),
        cmocka_unit_test(a_chain_promises_what_all_its_stages_do),
        cmocka_unit_test(the_stages_behind_a_select_are_lent_the_zone_in_its_order),
        cmocka_unit_test(the_zone_lent_is_the_scene),
        cmocka_unit_test(a_culler_that_tells_nonsense_after_build_is_refused_by_name),
        cmocka_unit_test(a_hierarchy_that_is_nonsense_is_refused_by_name),
        cmocka_unit_test(a_hierarchy_that_is_sound_is_lent),
        cmocka_unit_test(a_culler_that_fails_is_named_and_nothing_of_it_is_used),
        cmocka_unit_test(a_culler_without_memory_is_told_as_such),
    };
    return cmocka_run_group_tests_name("core chain", tests, NULL, NULL);
}
