#!/usr/bin/env bash
# run.sh types|unit|browser [name of a file]: a kind of the page's tests. Exit 77: skipped, with a word.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../web"
command -v node >/dev/null || { echo "skipped: there is no Node; remedy: scripts/install.sh web"; exit 77; }
if [[ $1 == types ]]; then
  [[ -d node_modules/typescript ]] || { echo "skipped: web/node_modules is not installed; remedy: scripts/install.sh web"; exit 77; }
  exec node node_modules/typescript/bin/tsc --noEmit
fi
exec node test/run.mjs "$@"
