# A closed room of 512 units with 40 random groups of boxes in it, of every class and kind of texture, on a coarse lattice, so
# that they overlap and share planes. usage: awk -v seed=N -f random_room.awk
# SPDX-License-Identifier: MIT
function box(x0, y0, z0, x1, y1, z1, t) {
  printf "{\n"
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x0, y0, z1, x0, y0, z0, x0, y1, z0, t
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x1, y1, z0, x1, y0, z0, x1, y0, z1, t
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x1, y0, z0, x0, y0, z0, x0, y0, z1, t
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x0, y1, z1, x0, y1, z0, x1, y1, z0, t
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x0, y1, z0, x0, y0, z0, x1, y0, z0, t
  printf "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", x1, y0, z1, x0, y0, z1, x0, y1, z1, t
  printf "}\n"
}
function pick(n) { seed = (seed * 16807) % 2147483647; return seed % n }
BEGIN {
  split("func_group func_detail func_detail_illusionary func_wall func_door csg_add func_group func_detail_wall", class, " ")
  split("rock brick *water {fence sky1 *slime rock brick metal", texture, " ")
  printf "{\n\"classname\" \"worldspawn\"\n"
  box(-16, -16, -16, 528, 528, 0, "floor"); box(-16, -16, 512, 528, 528, 528, "roof")
  box(-16, -16, 0, 0, 528, 512, "west"); box(512, -16, 0, 528, 528, 512, "east")
  box(0, -16, 0, 512, 0, 512, "south"); box(0, 512, 0, 512, 528, 512, "north")
  printf "}\n"
  for (i = 0; i < 40; i++) {
    printf "{\n\"classname\" \"%s\"\n\"angle\" \"%d\"\n", class[1 + pick(8)], 90 * pick(4)
    n = 1 + pick(3)
    for (k = 0; k < n; k++) {
      x = 16 * pick(29); y = 16 * pick(29); z = 16 * pick(29)
      box(x, y, z, x + 32 + 16 * pick(8), y + 32 + 16 * pick(8), z + 32 + 16 * pick(8), texture[1 + pick(9)])
    }
    printf "}\n"
  }
  for (i = 0; i < 30; i++) printf "{\n\"classname\" \"light\"\n\"origin\" \"%d %d %d\"\n}\n", 8 + 16 * pick(31), 8 + 16 * pick(31), 8 + 16 * pick(31)
}
