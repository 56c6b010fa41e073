# Shared by scripts that show that time follows what is seen, not what there is. Sourced; needs before: what, the plural of what is seen;
# third, the name of the third column; times, from one bin of what is seen to the next. A file has a view a line: there seen third - ns.
# SPDX-License-Identifier: MIT

fit() { # FILE: "there seen views a"
  awk '$2 > 0 && $5 > 0 {
    n++; x = log($2); z = log($1); y = log($5)
    sx += x; sz += z; sy += y; xx += x * x; zz += z * z; xz += x * z; xy += x * y; zy += z * y
  }
  END {
    xx -= sx * sx / n; zz -= sz * sz / n; xz -= sx * sz / n; xy -= sx * sy / n; zy -= sz * sy / n
    d = xx * zz - xz * xz
    there = (zy * xx - xy * xz) / d; seen = (xy * zz - zy * xz) / d
    printf "%.3f %.3f %d %.3f\n", there, seen, n, (sy - seen * sx - there * sz) / n
  }' "$1"
}

# The file that is judged: in the long tier by time; in the short one, which a busy machine runs too, by the third column: what is counted, not timed.
measured=time
[ -n "${PORTCULLIS_LONG:-}" ] || measured="the number of $third"
judged() { # FILE
  [ -z "${PORTCULLIS_LONG:-}" ] || { printf '%s' "$1"; return; }
  awk '{ $5 = $3 + 1; print }' "$1" >"$1.counts"
  printf '%s' "$1.counts"
}

show() { # FILE: a line a size: means, and of views that see 1, up to $times, $times^2, ... of them the mean time
  awk -v what="$what" -v third="$third" -v times="$times" '{
    n[$1]++; seen[$1] += $2; crossed[$1] += $3; ns[$1] += $5
    b = 0; for (k = 1; k < $2; k *= times) b++
    binned[$1, b] += $5; counted[$1, b]++; if (b > most) most = b
  }
  END {
    printf "  %7s %6s %9s %9s %8s  mean us of views that see", what, "views", "seen", third, "mean us"
    for (b = 0; b <= most; b++) printf " %7s", b == 0 ? "1" : "<=" times ^ b
    printf "\n"
    for (s = 1; s <= 1000000; s++) if (s in n) {
      printf "  %7d %6d %9.2f %9.2f %8.2f %26s", s, n[s], seen[s] / n[s], crossed[s] / n[s], ns[s] / n[s] / 1000, ""
      for (b = 0; b <= most; b++) if ((s, b) in counted) printf " %7.2f", binned[s, b] / counted[s, b] / 1000; else printf " %7s", "-"
      printf "\n"
    }
  }' "$1"
}

draw() { # FILE TITLE FITS SUBTITLE: FITS "there seen views start", as fit prints them, or nothing: no lines; the plot goes to $plot
  awk -v title="$2" -v fits="$3" -v subtitle="$4" -v what="$what" -v times="$times" '
  function x_seen(v) { return 70 + 400 * log(1.2 * v) / log(1.2 * seen_most) }
  function x_there(v) { return 560 + 260 * (log(v) - log(there_least)) / (log(there_most) - log(there_least)) }
  function height(us) { return 440 - 350 * (log(us) - log(us_least)) / (log(us_most) - log(us_least)) }
  function fitted(there, seen) { return exp(f[4] + f[1] * log(there) + f[2] * log(seen)) / 1000 }
  function text(x, y, anchor, what) { printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor, what }
  function line(x1, y1, x2, y2, style) { printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1, y1, x2, y2, style }
  function dot(x, y, r, colour) { printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%s\" fill=\"%s\"/>\n", x, y, r, colour }
  function panel(left, right, title, label,   k, us) { # frame and the ticks of time: 1, 2, 5
    for (k = -9; k <= 18; k++) {
      us = substr("125", (k + 9) % 3 + 1, 1) * 10 ^ (int((k + 9) / 3) - 3)
      if (us < us_least * 0.999 || us > us_most * 1.001) continue
      line(left, height(us), right, height(us), "stroke=\"#ddd\"")
      text(left - 6, height(us) + 4, "end", sprintf("%.3g", us))
    }
    printf "<rect x=\"%d\" y=\"90\" width=\"%d\" height=\"350\" fill=\"none\" stroke=\"#888\"/>\n", left, right - left
    text((left + right) / 2, 80, "middle", title)
    text((left + right) / 2, 476, "middle", label)
  }
  NR == FNR { # bounds and means
    if ($2 <= 0 || $5 <= 0) next
    if (!($1 in number)) { number[$1] = ++sizes; size[sizes] = $1 }
    if (!us_least || $5 < us_least) us_least = $5
    if ($5 > us_most) us_most = $5
    if ($2 > seen_most) seen_most = $2
    b = 0; for (k = 1; k < $2; k *= times) b++
    sum[b, $1] += $5; seen[b] += log($2); n[b, $1]++; all[b]++; if (b > bins) bins = b
    next
  }
  FNR == 1 {
    split("#332288 #88ccee #44aa99 #117733 #999933 #ddcc77 #cc6677", colour, " ")
    split(fits, f, " ")
    us_least /= 1100; us_most *= 1.25 / 1000; seen_top = seen_most
    for (k = 1; k < seen_most * 1.05; k *= times)
      ;
    seen_most = k
    there_least = size[1] / 1.5; there_most = size[sizes] * 1.5
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"940\" height=\"500\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"940\" height=\"500\" fill=\"white\"/>"
    printf "<text x=\"20\" y=\"26\" font-size=\"16\">%s: time follows the %s seen, not the %s there are</text>\n", title, what, what
    told = split(subtitle, line_of, ";")
    for (i = 1; i <= told; i++) text(20, 30 + 16 * i, "start", line_of[i])
    panel(70, 470, "each view; those of a size stand beside each other", what " seen")
    for (k = 1; k <= seen_most; k *= times) {
      line(x_seen(k), 90, x_seen(k), 445, "stroke=\"#ddd\"")
      text(x_seen(k), 458, "middle", k)
    }
    panel(560, 820, "means of views that see as many" (fits ? ", and the fit" : ""), what " there are")
    for (i = 1; i <= sizes; i++) {
      line(x_there(size[i]), 90, x_there(size[i]), 445, "stroke=\"#ddd\"")
      if (sizes < 5 || i % 2) text(x_there(size[i]), 458, "middle", size[i])
    }
    print "<text transform=\"translate(24 265) rotate(-90)\" text-anchor=\"middle\">culling, microseconds a view</text>"
    text(84, 110, "start", what " there are")
    for (i = 1; i <= sizes; i++) {
      dot(90, 106 + 18 * i, 4, colour[(i - 1) % 7 + 1])
      text(102, 110 + 18 * i, "start", size[i])
    }
    if (fits) {
      line(84, 124 + 18 * sizes, 98, 124 + 18 * sizes, "stroke=\"black\"")
      text(102, 128 + 18 * sizes, "start", "fit, for " size[1] " and " size[sizes])
    }
    for (b = 0; b <= bins; b++) for (i = 1; i <= sizes; i++)
      if ((b, size[i]) in sum) dot(x_there(size[i]), height(sum[b, size[i]] / n[b, size[i]] / 1000), 4, colour[(i - 1) % 7 + 1])
    for (b = 0; b <= bins; b++) if (all[b]) {
      mean = exp(seen[b] / all[b])
      if (fits) line(x_there(size[1]), height(fitted(size[1], mean)), x_there(size[sizes]), height(fitted(size[sizes], mean)), "stroke=\"black\"")
      least = b == 0 ? 1 : times ^ (b - 1) + 1
      label = (least == times ^ b ? "" : times > 2 ? "to " : least " to ") times ^ b " seen"
      if (fits || times ^ b > 16) text(825, height(fits ? fitted(size[sizes], mean) : sum[b, size[sizes]] / n[b, size[sizes]] / 1000) + 4, "start", label)
    }
  }
  $2 > 0 && $5 > 0 {
    place = sprintf("%.0f %.0f", $2, height($5 / 1000))
    if (!((place, $1) in drawn)) dot(x_seen($2) + 3 * (number[$1] - (sizes + 1) / 2), height($5 / 1000), 1.5, colour[(number[$1] - 1) % 7 + 1])
    drawn[place, $1] = 1
  }
  END {
    for (i = 1; fits && i <= sizes; i += sizes > 1 ? sizes - 1 : 1) line(x_seen(1), height(fitted(size[i], 1)), x_seen(seen_top), height(fitted(size[i], seen_top)), "stroke=\"black\"")
    print "</svg>"
  }' "$1" "$1" >"$plot"
}
