# SPDX-License-Identifier: Apache-2.0
# A hand and an eye for the walk: events of X, and what can be seen from outside. Where things are is read from the map
# that the program writes when BEAM_STUDIO_MAP asks for it (app/gui/widget_map); pixels are never written down here.
# Expects: OUT (folder of the pictures), BEAM_STUDIO_MAP, STUDIO (the program).

step_number=0
step_name=start

say() { printf '%s\n' "$*"; }

# The picture of what was there, then the end.
die() {
  say "FAILED at \"$step_name\": $*" >&2
  import -window root "$OUT/failed.png" 2>/dev/null || true
  cp "$BEAM_STUDIO_MAP" "$OUT/failed.map.json" 2>/dev/null || true
  [ -s "$OUT/studio.log" ] && sed 's/^/  program: /' "$OUT/studio.log" >&2
  exit 1
}

step() {
  step_number=$((step_number + 1))
  step_name=$*
  say "$(printf '%2d' "$step_number") $(date +%T) $step_name"
}

# picture NAME: of the whole screen, numbered by the step.
picture() {
  shot=$OUT/$(printf '%02d' "$step_number")-$1.png
  import -window root "$shot" || die "no picture could be taken"
}

# differ A B SHARE: at least that share of the pixels, in thousandths, are other ones.
differ() {
  local pixels changed
  pixels=$(identify -format '%[fx:w*h]' "$1")
  changed=$(compare -metric AE -fuzz 3% "$1" "$2" null: 2>&1 | sed 's/[^0-9.e+].*//') || true
  awk -v c="$changed" -v n="$pixels" -v s="$3" 'BEGIN { exit !(1000 * c / n >= s) }' ||
    die "$(basename "$1") and $(basename "$2") look alike: $changed of $pixels pixels differ, expected $3 in a thousand"
}

# --- What is there ---

ask() { jq -r "$@" "$BEAM_STUDIO_MAP"; }

# The map of a moment that began after this call.
fresh() {
  local before now limit=$((SECONDS + 20))
  before=$(ask .tick)
  while now=$(ask .tick) && [ "$now" -lt $((before + 2)) ]; do
    [ $SECONDS -lt $limit ] || die "the window does not answer for 20 s"
    kill -0 "$studio" 2>/dev/null || die "the program is gone"
    sleep 0.05
  done
}

# seen FILTER [ARGS]: whether a widget passes the filter of jq.
seen() {
  local filter=$1
  shift
  [ "$(ask "$@" "any(.widgets[]; $filter)")" = true ]
}

# wait_for SECONDS WHAT FILTER [ARGS]
wait_for() {
  local limit=$((SECONDS + $1)) what=$2
  shift 2
  until seen "$@"; do
    [ $SECONDS -lt "$limit" ] || die "$what did not come"
    kill -0 "$studio" 2>/dev/null || die "the program is gone while waiting: $what"
    sleep 0.1
  done
}

shows() { seen '.text | test($re)' --arg re "$1"; }
wait_shows() { wait_for "$1" "\"$2\"" '.text | test($re)' --arg re "$2"; }

window_title() { ask 'first(.widgets[] | select(.kind == "beam::MainWindow") | .text)'; }

middle_of='.place | "\(.[0] + .[2] / 2 | floor) \(.[1] + .[3] / 2 | floor)"'
# middle FILTER [ARGS]: "x y" of the first widget that passes.
middle() {
  local filter=$1
  shift
  ask "$@" "first(.widgets[] | select($filter)) | $middle_of"
}

# field_beside LABEL WHAT: of the field on the right of a label, its text (.text) or where it is.
field_beside() {
  ask --arg re "$1" '
    def height: .place[1] + .place[3] / 2;
    first(.widgets[] | select((.kind | test("Label")) and (.text | test($re)))) as $words
    | [.widgets[] | select((.kind | test("LineEdit")) and .place[0] > $words.place[0])]
    | min_by((height - ($words | height)) | fabs)
    | '"${2:-$middle_of}"
}
value_beside() { field_beside "$1" .text; }

# --- What the hand does ---

click_at() {
  xdotool mousemove "$1" "$2"
  sleep 0.08
  xdotool click 1
  fresh
}

# press KIND WORDS: KIND and WORDS are regular expressions; what is grey cannot be pressed.
press() {
  wait_for 10 "$1 \"$2\" that can be pressed" '(.kind | test($k)) and (.text | test($re)) and .enabled' \
    --arg k "$1" --arg re "$2"
  # shellcheck disable=SC2046  # two words
  click_at $(middle '(.kind | test($k)) and (.text | test($re)) and .enabled' --arg k "$1" --arg re "$2")
}

# In a dialog alone: its words may stand on the window under it, too.
dialog='(.window | test("Dialog|MessageBox"))'
press_in_dialog() {
  wait_for 10 "a dialog with \"$1\"" "$dialog"' and (.kind | test("Button")) and (.text | test($re))' --arg re "$1"
  local x y
  read -r x y <<<"$(middle "$dialog"' and (.kind | test("Button")) and (.text | test($re))' --arg re "$1")"
  # The program may end by it: no answer is waited for.
  xdotool mousemove --sync "$x" "$y" click 1
}

key() {
  xdotool key "$@"
  fresh
}

# fill LABEL TEXT: types, and leaves the cursor where it is.
fill() {
  local at
  at=$(field_beside "$1") || die "there is no field beside \"$1\""
  [ -n "$at" ] && [ "$at" != null ] || die "there is no field beside \"$1\""
  # shellcheck disable=SC2086  # two words
  click_at $at
  xdotool key ctrl+a
  xdotool type --delay 30 "$2"
  fresh
}

# drag X1 Y1 X2 Y2, with stops between.
drag() {
  xdotool mousemove "$1" "$2" mousedown 1
  local i
  for i in 1 2 3 4 5 6; do
    xdotool mousemove $(($1 + ($3 - $1) * i / 6)) $(($2 + ($4 - $2) * i / 6))
    sleep 0.1
  done
  xdotool mouseup 1
  fresh
}

# --- The program ---

start_studio() {
  rm -f "$BEAM_STUDIO_MAP"
  "$STUDIO" "$@" >>"$OUT/studio.log" 2>&1 &
  studio=$!
  local limit=$((SECONDS + 30))
  until [ -s "$BEAM_STUDIO_MAP" ]; do
    [ $SECONDS -lt $limit ] || die "no window within 30 s"
    kill -0 $studio 2>/dev/null || die "the program ended at once"
    sleep 0.1
  done
  wait_for 20 "the window" '.kind == "beam::MainWindow"'
  fresh
}

# Waits for its end by itself.
await_end() {
  local limit=$((SECONDS + $1)) code=0
  while kill -0 "$studio" 2>/dev/null; do
    [ $SECONDS -lt $limit ] || die "the program did not end within $1 s"
    sleep 0.1
  done
  wait "$studio" || code=$?
  [ $code -eq 0 ] || die "the program ended with $code"
}
