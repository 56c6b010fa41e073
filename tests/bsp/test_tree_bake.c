// A tree in bytes: the same when it comes back, and bytes that are not one are refused or harmless.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { HEAD_BYTES = 80, CHECK_AT = 72 }; // bake.c

static void scene_make(hand_zone *zone, uint64_t seed)
{
    scene_of_boxes(&(box_scene){4, 32, 16, seed}, zone);
    hand_zone_cluster(zone, (cull_box){{-1, -1, -1}, {1, 1, 1}});
    grid_end(zone, ZONE_EXACT);
}

static void *saved(const bsp_tree *tree, uint64_t *size)
{
    *size = bsp_tree_save(tree, NULL, 0);
    char *blob = malloc(*size + 1);
    assert_non_null(blob);
    blob[*size] = 0x5a;
    assert_int_equal(bsp_tree_save(tree, blob, *size), *size);
    assert_int_equal(blob[*size], 0x5a);
    return blob;
}

static void assert_same_tree(const bsp_tree *a, const bsp_tree *b)
{
    assert_no_fault(tree_difference(a, b));
    assert_memory_equal(a->entries, b->entries, a->entry_count * sizeof *a->entries);
    assert_memory_equal(a->points, b->points, a->point_count * sizeof *a->points);
    assert_memory_equal(a->leaf_boxes, b->leaf_boxes, a->leaf_count * sizeof *a->leaf_boxes);
    assert_int_equal(a->plane_count, b->plane_count);
    assert_memory_equal(a->planes, b->planes, a->plane_count * sizeof *a->planes);
    if (a->node_count) assert_memory_equal(a->node_boxes, b->node_boxes, a->node_count * sizeof *a->node_boxes);
    assert_true(a->slack == b->slack && a->steps_per_metre == b->steps_per_metre);
    assert_true(a->depth == b->depth && a->splits == b->splits && a->spanning == b->spanning && a->bent_leaves == b->bent_leaves);
}

static void a_tree_comes_back_from_its_bytes_to_the_last_bit(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 9; seed++) {
        hand_zone zone;
        culler_host host, other;
        bsp_tree tree, back;
        uint64_t size;
        const bsp_wish wish = {(bsp_split)(seed % 3), (bsp_choose)(seed / 3 % 3), seed % 2 ? 0 : 3, 0};
        scene_make(&zone, seed);
        tree_of(&zone, wish, &host, &tree);
        void *bytes = saved(&tree, &size);
        const cull_blob blob = {bytes, size};
        const bsp_source from = {&zone.zone, &blob, wish};
        culler_host_init(&other, 0);
        assert_int_equal(bsp_tree_build(&other.host, &from, &back), CULL_OK);
        assert_no_fault(tree_fault(&zone.zone, &back));
        assert_same_tree(&tree, &back);
        tree_end(&other, &back);
        tree_end(&host, &tree);
        free(bytes);
        hand_zone_free(&zone);
    }
}

static cull_result load(const hand_zone *zone, const void *bytes, uint64_t size, bsp_wish wish)
{
    culler_host host;
    bsp_tree tree;
    const cull_blob blob = {bytes, size};
    const bsp_source from = {&zone->zone, &blob, wish};
    culler_host_init(&host, 0);
    const cull_result result = bsp_tree_build(&host.host, &from, &tree);
    if (result == CULL_OK) bsp_tree_free(&host.host, &tree);
    else assert_int_equal(host.lines, 1);
    assert_true(failing_allocator_is_clean(&host.memory));
    return result;
}

static void bytes_of_another_zone_or_wish_or_length_are_refused(void **state)
{
    (void)state;
    hand_zone zone, other;
    culler_host host;
    bsp_tree tree;
    uint64_t size;
    const bsp_wish wish = {BSP_WHOLE, BSP_BALANCE, 0, 0};
    scene_make(&zone, 1);
    scene_make(&other, 2);
    tree_of(&zone, wish, &host, &tree);
    char *bytes = saved(&tree, &size);
    assert_int_equal(load(&zone, bytes, size, wish), CULL_OK);
    assert_int_equal(load(&other, bytes, size, wish), CULL_ERR_BLOB);
    assert_int_equal(load(&zone, bytes, size, (bsp_wish){BSP_SPLIT_LEAVES, BSP_BALANCE, 0, 0}), CULL_ERR_BLOB);
    assert_int_equal(load(&zone, bytes, size, (bsp_wish){BSP_WHOLE, BSP_SAH, 0, 0}), CULL_ERR_BLOB);
    assert_int_equal(load(&zone, bytes, size, (bsp_wish){BSP_WHOLE, BSP_BALANCE, 9, 0}), CULL_ERR_BLOB);
    assert_int_equal(load(&zone, NULL, 0, wish), CULL_ERR_BLOB);
    for (uint64_t cut = 0; cut < size; cut += cut < 200 ? 1 : 97) {
        char *part = malloc(cut + 1);
        memcpy(part, bytes, cut);
        assert_int_equal(load(&zone, part, cut, wish), CULL_ERR_BLOB);
        free(part);
    }
    tree_end(&host, &tree);
    free(bytes);
    hand_zone_free(&zone);
    hand_zone_free(&other);
}

static void any_byte_changed_is_noticed(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    uint64_t size;
    const bsp_wish wish = {BSP_SPLIT_NODES, BSP_BALANCE, 0, 0};
    scene_make(&zone, 3);
    tree_of(&zone, wish, &host, &tree);
    char *bytes = saved(&tree, &size);
    for (uint64_t i = 0; i < size; i++) {
        const uint64_t splits_at = 8 + 8 * 4, bent_at = splits_at + 8; // figures for the bench: nothing rests on them
        if ((i >= splits_at && i < splits_at + 4) || (i >= bent_at && i < bent_at + 4)) continue;
        bytes[i] ^= 0x11;
        assert_int_equal(load(&zone, bytes, size, wish), CULL_ERR_BLOB);
        bytes[i] ^= 0x11;
    }
    tree_end(&host, &tree);
    free(bytes);
    hand_zone_free(&zone);
}

static void sign(char *bytes, uint64_t size)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint64_t i = HEAD_BYTES; i + 4 <= size; i += 4) {
        uint32_t word;
        memcpy(&word, bytes + i, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    memcpy(bytes + CHECK_AT, &hash, sizeof hash);
}

static void signed_bytes_that_name_one_thing_twice_are_refused(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    uint64_t size;
    const bsp_wish wish = {BSP_WHOLE, BSP_BALANCE, 0, 0};
    const grid_loop front = {{{0, 0, 0}, {64, 0, 0}, {64, 64, 0}, {0, 64, 0}}, 4}, back = {{{0, 64, 0}, {64, 64, 0}, {64, 0, 0}, {0, 0, 0}}, 4};
    hand_zone_open(&zone, 4, 16);
    for (int i = 0; i < 2; i++) grid_wall(&zone, &front); // alike but for their numbers
    for (int i = 0; i < 2; i++) grid_wall(&zone, &back);
    grid_end(&zone, ZONE_EXACT);
    tree_of(&zone, wish, &host, &tree);
    assert_int_equal(tree.leaf_count, 2);
    char *bytes = saved(&tree, &size);
    const uint64_t child_at = HEAD_BYTES + sizeof(uint32_t), order_at = HEAD_BYTES + sizeof(bsp_node) + 2 * sizeof(bsp_leaf) + 4 * sizeof(bsp_entry);
    uint32_t word;
    memcpy(&word, bytes + order_at, sizeof word);
    memcpy(bytes + order_at + sizeof word, &word, sizeof word);
    sign(bytes, size);
    assert_int_equal(load(&zone, bytes, size, wish), CULL_ERR_BLOB); // one item in two places
    free(bytes);
    bytes = saved(&tree, &size);
    memcpy(&word, bytes + child_at, sizeof word);
    memcpy(bytes + child_at + sizeof word, &word, sizeof word);
    sign(bytes, size);
    assert_int_equal(load(&zone, bytes, size, wish), CULL_ERR_BLOB); // one leaf on both sides
    free(bytes);
    tree_end(&host, &tree);
    hand_zone_free(&zone);
}

static uint32_t read_all(const bsp_tree *t) // by the ways that a walk would take: out of bounds shows under a sanitizer
{
    uint32_t sum = 0, used = 0, ways[1024];
    ways[used++] = t->node_count ? 0 : BSP_LEAF;
    while (used) {
        const uint32_t at = ways[--used], is_leaf = at >> 31;
        const uint32_t first = is_leaf ? t->leaves[at & ~BSP_LEAF].first_entry : t->nodes[at].first_entry;
        const uint32_t count = is_leaf ? t->leaves[at & ~BSP_LEAF].entry_count : t->nodes[at].entry_count;
        for (uint32_t e = first; e < first + count; e++) {
            sum += t->order[t->entries[e].item];
            for (uint32_t i = 0; i < t->entries[e].point_count; i++) sum += t->points[t->entries[e].first_point + i].x > 0;
            if (t->entries[e].plane != BSP_NONE) sum += t->planes[t->entries[e].plane].normal[0] > 0;
        }
        if (is_leaf) continue;
        sum += t->planes[t->nodes[at].plane].normal[1] > 0;
        assert_true(used + 2 <= 1024);
        ways[used++] = t->nodes[at].child[0];
        ways[used++] = t->nodes[at].child[1];
    }
    return sum;
}

static void signed_bytes_of_any_content_are_refused_or_a_tree_that_can_be_walked(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    uint64_t size, seed = 11;
    uint32_t refused = 0, taken = 0;
    const bsp_wish wish = {BSP_WHOLE, BSP_BALANCE, 0, 0};
    scene_make(&zone, 4);
    tree_of(&zone, wish, &host, &tree);
    char *good = saved(&tree, &size), *bytes = malloc(size);
    static const uint32_t words[8] = {0, 1, 2, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff, 0xfffffffe};
    for (uint32_t round = 0; round < 6000; round++) {
        memcpy(bytes, good, size);
        const uint32_t changes = 1 + random_below(&seed, 3);
        for (uint32_t c = 0; c < changes; c++) {
            const uint64_t at = 4 * (uint64_t)random_below(&seed, (uint32_t)(size / 4));
            uint32_t word;
            memcpy(&word, bytes + at, 4);
            const uint32_t kind = random_below(&seed, 3);
            word = kind == 0 ? words[random_below(&seed, 8)] : kind == 1 ? word + random_below(&seed, 5) - 2 : random_below(&seed, 200);
            memcpy(bytes + at, &word, 4);
        }
        sign(bytes, size);
        culler_host own;
        bsp_tree back;
        const cull_blob blob = {bytes, size};
        const bsp_source from = {&zone.zone, &blob, wish};
        culler_host_init(&own, 0);
        const cull_result result = bsp_tree_build(&own.host, &from, &back);
        if (result == CULL_OK) {
            taken += read_all(&back) != 0xffffffff;
            bsp_tree_free(&own.host, &back);
        } else refused += result == CULL_ERR_BLOB;
        assert_true(failing_allocator_is_clean(&own.memory));
    }
    assert_int_equal(refused + taken, 6000);
    assert_true(refused > 3000 && taken > 10);
    tree_end(&host, &tree);
    free(good);
    free(bytes);
    hand_zone_free(&zone);
}

// By every compiler: the tree of 60 triangles that cross each other.
static void the_bytes_of_a_tree_are_the_same_on_every_machine(void **state)
{
    (void)state;
    static const uint64_t known[3] = {0x154d1d8b16bbb214u, 0x94d7ffa1229ff4c7u, 0xd6874cac32ee27c0u};
    for (int i = 0; i < 3; i++) {
        hand_zone zone;
        culler_host host;
        bsp_tree tree;
        uint64_t size, hash = 0xcbf29ce484222325u;
        scene_of_polygons(60, 5, &zone);
        grid_end(&zone, ZONE_FLOAT);
        tree_of(&zone, (bsp_wish){BSP_WHOLE, (bsp_choose)i, 0, 0}, &host, &tree);
        unsigned char *bytes = saved(&tree, &size);
        for (uint64_t b = 0; b < size; b++) hash = (hash ^ bytes[b]) * 0x100000001b3u;
        if (hash != known[i]) print_message("choice %d: %#llx\n", i, (unsigned long long)hash);
        assert_true(hash == known[i]);
        free(bytes);
        tree_end(&host, &tree);
        hand_zone_free(&zone);
    }
}

static void whichever_allocation_fails_while_loading_nothing_is_left(void **state)
{
    (void)state;
    hand_zone zone;
    culler_host host;
    bsp_tree tree;
    uint64_t size, fail_at = 0;
    const bsp_wish wish = {BSP_WHOLE, BSP_BALANCE, 0, 0};
    scene_make(&zone, 5);
    tree_of(&zone, wish, &host, &tree);
    void *bytes = saved(&tree, &size);
    const cull_blob blob = {bytes, size};
    const bsp_source from = {&zone.zone, &blob, wish};
    for (cull_result result = CULL_ERR_MEMORY; result != CULL_OK;) {
        culler_host own;
        bsp_tree back;
        culler_host_init(&own, ++fail_at);
        result = bsp_tree_build(&own.host, &from, &back);
        if (result == CULL_OK) bsp_tree_free(&own.host, &back);
        else assert_int_equal(result, CULL_ERR_MEMORY);
        assert_true(failing_allocator_is_clean(&own.memory));
    }
    assert_true(fail_at > 10);
    tree_end(&host, &tree);
    free(bytes);
    hand_zone_free(&zone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tree_comes_back_from_its_bytes_to_the_last_bit),
        cmocka_unit_test(bytes_of_another_zone_or_wish_or_length_are_refused),
        cmocka_unit_test(any_byte_changed_is_noticed),
        cmocka_unit_test(signed_bytes_that_name_one_thing_twice_are_refused),
        cmocka_unit_test(signed_bytes_of_any_content_are_refused_or_a_tree_that_can_be_walked),
        cmocka_unit_test(the_bytes_of_a_tree_are_the_same_on_every_machine),
        cmocka_unit_test(whichever_allocation_fails_while_loading_nothing_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
