#!/usr/bin/env bash
# Does all that src/cli/GUIDE.md tells a newcomer to do, with few photons and short searches.
#   tests/cli/guide.sh [PROGRAM]
# The guide's toml blocks, one after the other, are the scene cob.toml; its sh blocks run in order, each command
# must succeed; each row "| `options` | `words` |" must make `explain` or, where it begins with a command, that
# command say those words.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${1:-build/catoptric}")
guide=$PWD/src/cli/GUIDE.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() {
  echo "FAILED: $1" >&2
  exit 1
}

# What the guide calls: the program with settings that take little time.
mkdir "$folder/bin"
cat >"$folder/bin/catoptric" <<EOF
#!/bin/sh
"$program" "\$@" --quiet --set model.photons=2048 --set model.replicates=2 --set search.most_evaluations=12 \\
  --set sensitivity.modes=0 --set near_field.samples=64 || [ \$? = 5 ]  # 5: ended by the search's limit, as the guide says
EOF
chmod +x "$folder/bin/catoptric"

blocks() { awk -v kind="$1" '$0 == "```" kind { inside = 1; next } $0 == "```" { inside = 0 } inside' "$guide"; }
cd "$folder"
blocks toml >cob.toml
blocks sh >commands.sh
[ -s cob.toml ] || fail "the guide has no scene"
[ "$(grep -c '^catoptric' commands.sh)" -ge 6 ] || fail "the guide has hardly a command"
PATH="$folder/bin:$PATH" sh -eu commands.sh >said 2>&1 || fail "a command of the guide: $(tail -n 3 said)"

# The mistakes, with the program itself: words are compared, not figures.
rows=0
while IFS='`' read -r _ options _ words _; do
  case "$options" in
    --*) options="explain cob.toml $options" ;;
  esac
  said=$(eval "\"\$program\" $options" 2>&1) || true
  case "$said" in
    *"$words"*) rows=$((rows + 1)) ;;
    *) fail "catoptric $options does not say \"$words\" but: $said" ;;
  esac
done < <(grep '^| `' "$guide")
[ "$rows" -ge 5 ] || fail "the guide has hardly a mistake"
echo "the guide: $(grep -c '^catoptric' commands.sh) commands and $rows mistakes as it says"
