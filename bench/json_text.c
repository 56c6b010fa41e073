// Text as JSON: see json_text.h. Well-formed UTF-8 is that of Unicode's table 3-7.
// SPDX-License-Identifier: MIT
#include "json_text.h"

#include <stddef.h>
#include <string.h>

// Bytes of the character at `at`; 0 when it is none. The closing zero ends every sequence.
static size_t character_length(const unsigned char *at)
{
    if (at[0] < 0x80) return 1;
    if (at[0] < 0xc2 || at[0] > 0xf4) return 0;
    const unsigned char least = at[0] == 0xe0 ? 0xa0 : at[0] == 0xf0 ? 0x90 : 0x80; // no longer than needed
    const unsigned char most = at[0] == 0xed ? 0x9f : at[0] == 0xf4 ? 0x8f : 0xbf;  // no half of a pair, none above U+10FFFF
    const size_t length = at[0] < 0xe0 ? 2 : at[0] < 0xf0 ? 3 : 4;
    if (at[1] < least || at[1] > most) return 0;
    for (size_t i = 2; i < length; ++i)
        if ((at[i] & 0xc0) != 0x80) return 0;
    return length;
}

json_t *json_text(const char *text)
{
    char clean[JSON_TEXT_BYTES];
    size_t used = 0;
    if (!text) return json_null();
    while (*text) {
        const size_t length = character_length((const unsigned char *)text), bytes = length ? length : 1;
        if (used + bytes >= sizeof clean) break;
        memcpy(clean + used, length ? text : "?", bytes);
        used += bytes;
        text += bytes;
    }
    clean[used] = 0;
    return json_string(clean);
}
