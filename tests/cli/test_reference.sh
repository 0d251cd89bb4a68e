# SPDX-License-Identifier: Apache-2.0
# The reference page is what the tables say, every scene of the house is free of mistakes, and the schema is JSON.
expect 0 "$tsuya" params --markdown
same out.txt "$TSUYA_SOURCE/docs/reference.md"
for scene in "$TSUYA_SOURCE"/scenes/*/scene.yaml; do
    [ ! -f "${scene%scene.yaml}fetch" ] || continue # shows what is not part of the house
    expect 0 "$tsuya" check "$scene"
    prints "no mistakes"
done
expect 0 "$tsuya" params --schema
prints '"$schema"'
