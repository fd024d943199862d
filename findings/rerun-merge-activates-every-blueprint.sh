#!/usr/bin/env bash
# Finding: `rerun rrd merge` and `rerun rrd optimize` activate every blueprint store of a file, also
# one that the file itself never activates, and write the stores in an order that differs from run
# to run. The viewer shows the blueprint that is activated last. A store of kind "blueprint" is
# therefore no place for anything but the layout that shall be shown.
#
# Usage: findings/rerun-merge-activates-every-blueprint.sh [VERSION]
#
# Installs the wheel `rerun-sdk` of that version in a temporary folder, writes a small recording
# with Rerun's own Python library, and rewrites it. Prints what it saw. Exits with 0 while Rerun
# behaves so, with 1 when it no longer does, with 2 when nothing could be tried.
set -euo pipefail
version=${1:-0.41.0}
runs=16

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME="$folder" NO_COLOR=1
{ python3 -m venv "$folder/venv" &&
  "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "rerun-sdk==$version"
} >"$folder/log" 2>&1 || { tail -3 "$folder/log" >&2; exit 2; }
rerun=$folder/venv/bin/rerun
"$rerun" analytics disable >/dev/null 2>&1 || true
"$rerun" --version | head -1

cat >"$folder/write.py" <<'PYTHON'
import sys
import rerun as rr
import rerun.blueprint as rrb

recording = rr.RecordingStream("finding", recording_id="recording")
recording.save(sys.argv[1])
shown = rrb.Blueprint(rrb.Spatial2DView(name="shown"))
recording.send_blueprint(shown, make_active=True, make_default=True)
spare = rrb.Blueprint(rrb.Spatial2DView(name="spare"))
recording.send_blueprint(spare, make_active=False, make_default=False)
recording.log("point", rr.Points2D([[0, 0]]), static=True)
recording.disconnect()
PYTHON
"$folder/venv/bin/python" "$folder/write.py" "$folder/original.rrd" || exit 2

# the stores that a file activates, in order, by the digits of their names
activated() {
  "$rerun" rrd print "$1" 2>/dev/null | sed 's/\x1b\[[0-9;]*m//g' |
    sed -n 's/^BlueprintActivationCommand(.*"rec_\([0-9a-f]*\)".*make_active: true.*/\1/p'
}
original=$(activated "$folder/original.rrd")
if [ "$(wc -w <<<"$original")" != 1 ]; then
  echo "the original does not activate one store: '$original'" >&2
  exit 2
fi
echo "original: activates 1 of its 2 blueprint stores"

changed=0
for command in merge optimize; do
  both=0 others=0
  for _ in $(seq "$runs"); do
    "$rerun" rrd "$command" "$folder/original.rrd" -o "$folder/new.rrd" >"$folder/log" 2>&1 ||
      { tail -3 "$folder/log" >&2; exit 2; }
    now=$(activated "$folder/new.rrd")
    [ "$(wc -w <<<"$now")" != 2 ] || both=$((both + 1))
    [ "$(tail -1 <<<"$now")" = "$original" ] || others=$((others + 1))
  done
  echo "rrd $command: $both of $runs files activate both stores," \
    "$others of them the other store last"
  if [ "$both" != "$runs" ] || [ "$others" = 0 ] || [ "$others" = "$runs" ]; then
    changed=1
  fi
done
[ "$changed" = 0 ] || echo "rerun-sdk $version no longer behaves as the finding says"
exit "$changed"
