#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A person's way through the studio, from outside: with nothing -> sample -> a value typed and not left -> run -> cancel ->
# resume -> scrub -> compare -> close during a run -> reopen. A picture at each step in OUT.
# Usage: xvfb-run -a -s "-screen 0 1600x1000x24" tests/walk/walk.sh BIN OUT
set -euo pipefail

for tool in xdotool openbox import compare identify jq; do
  command -v $tool >/dev/null || { echo "the walk needs $tool: apt-get install xdotool openbox imagemagick jq" >&2; exit 1; }
done
BIN=$(realpath "${1:?the folder of beam and beam-studio}")
OUT=${2:?a folder for the pictures}
STUDIO=$BIN/beam-studio
rm -rf "$OUT" && mkdir -p "$OUT" && OUT=$(realpath "$OUT")
. "$(dirname "$0")/hand.sh"

# A home of its own: nothing of this person's machine is seen or changed.
home=$(mktemp -d)
export HOME=$home XDG_CONFIG_HOME=$home/config XDG_DATA_HOME=$home/data XDG_CACHE_HOME=$home/cache
export XDG_DOCUMENTS_DIR=$home/documents LIBGL_ALWAYS_SOFTWARE=1 BEAM_STUDIO_MAP=$home/map.json
mkdir -p "$XDG_CONFIG_HOME" "$XDG_DATA_HOME/beam-studio" "$XDG_CACHE_HOME"
studio=0
trap 'kill $studio $manager 2>/dev/null || true; rm -rf "$home"' EXIT
openbox --sm-disable >/dev/null 2>&1 &
manager=$!

# The sample as the program would make it, only small: the walk is about the window.
"$BIN/beam" sample "$XDG_DATA_HOME/beam-studio/Sample" --frames 4 --size 96x128 --cameras 8 --samples 8 >/dev/null
project=$XDG_DATA_HOME/beam-studio/Sample.beam
in_project() { jq -r "$1" "$project/project.json" 2>/dev/null; }
# Every finished step leaves one, written last.
finished() { find "$project/results" -name result.json -exec jq -r .step {} + 2>/dev/null | grep -c "^$1$" || true; }

step "start with nothing"
start_studio
[ "$(window_title)" = "BEAM Studio" ] || die "the title is \"$(window_title)\""
picture start
before=$shot

step "press Open sample"
press QPushButton '^Open sample$'
wait_for 30 "the sample in the title" '.kind == "beam::MainWindow" and (.text | test("^Sample"))'
sleep 2
picture opened
differ "$before" "$shot" 20

step "the sample begins with the quick preset"
press Tab '^Settings$'
wait_for 10 "the preset draft" '.kind == "beam::QuietCombo" and .text == "draft"'
picture preset

step "type a value and stay in the field"
fill '^Iterations$' 200
[ "$(value_beside '^Iterations$')" = 200 ] || die "the field holds \"$(value_beside '^Iterations$')\""
picture typed

running='(.kind | test("Button")) and (.text | test("^(Cancel|Stop)")) and .enabled'
step "run"
press QToolButton '^Run'
wait_for 30 "a run that can be cancelled" "$running"
sleep 1
picture running
[ "$(in_project '.settings["surface.iterations"]')" = 200 ] ||
  die "200 was typed, the run has $(in_project '.settings["surface.iterations"]')"

step "cancel"
press 'QPushButton|QToolButton' '^(Cancel|Stop)'
# Where it asks when: now.
if seen '.kind == "Entry" and (.text | test("[Nn]ow"))'; then press Entry '[Nn]ow'; fi
wait_shows 20 'Cancelled|Stopped'
picture cancelled
done_before=$(finished '.*')

step "resume"
press QToolButton '^Run'
wait_shows 120 '^Done'
sleep 2
picture done
solved=$shot
[ "$(finished 'materials.fit')" -ge 1 ] || die "the run ended without materials"
[ "$(finished '.*')" -gt "$done_before" ] || die "the second run added nothing"

step "orbit"
read -r x y <<<"$(middle '.kind == "beam::SplatView"')"
drag "$x" "$y" $((x + 150)) $((y + 20))
sleep 2
picture orbited
differ "$solved" "$shot" 1

step "scrub the timeline"
read -r left top width height <<<"$(ask 'first(.widgets[] | select(.kind == "beam::TimelineLanes")) | .place | map(floor) | join(" ")')"
drag $((left + width / 4)) $((top + height / 3)) $((left + width - 20)) $((top + height / 3))
wait_shows 10 '000003'
sleep 1
picture scrubbed
drag $((left + width - 20)) $((top + height / 3)) $((left + width / 4)) $((top + height / 3))
wait_shows 10 '000000'

step "compare a photograph with the render"
press Tab '^Images$'
sleep 1
picture photograph
alone=$shot
box=$(middle '.kind == "beam::QuietCombo" and .text == "none"')
[ -n "$box" ] || die "there is no second picture to choose"
# shellcheck disable=SC2086  # two words
click_at $box
press Row '[Rr]ender|[Ll]it'
sleep 3
picture compared
differ "$alone" "$shot" 5

step "close during a run"
press Tab '^Splats$'
press Tab '^Settings$'
fill '^Iterations$' 4000
press QToolButton '^Run'
wait_for 30 "a run that can be cancelled" "$running"
sleep 2
xdotool key alt+F4
fresh
picture closing
seen "$dialog" || die "closing during a run does not ask"
if seen "$dialog"' and (.text | test("[Nn]ow"))'; then
  press_in_dialog '[Nn]ow'
else
  press_in_dialog '^(Stop|Close|Quit|End)'
fi
await_end 20
jq -e . "$project/project.json" >/dev/null || die "project.json is broken"

step "reopen"
start_studio
picture start-again
press QPushButton 'Sample'
wait_for 30 "the project in the title" '.kind == "beam::MainWindow" and (.text | test("^Sample"))'
sleep 3
picture reopened
press Tab '^Settings$'
[ "$(value_beside '^Iterations$')" = 4000 ] || die "the typed value is lost: \"$(value_beside '^Iterations$')\""
picture settings-again
xdotool key alt+F4
await_end 20
say "the walk ends well; pictures in $OUT"
