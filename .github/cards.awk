# SPDX-License-Identifier: MIT
# Doxygen's input filter. The cards in the headers are plain text: equations indented by three spaces become code blocks, lines
# such as "Source    [key]" become items of a list, and '<' is no tag. Lines are neither added nor removed.
function plain(line, place) {  # from `place` on
  head = substr(line, 1, place - 1)
  tail = substr(line, place)
  gsub(/[<#]/, "\\\\&", tail)
  return head tail
}
function label(line, quote) {
  match(line, /\/\/\/ [A-Za-z0-9_-]+/)
  return substr(line, 1, RSTART - 1) "/// - " quote substr(line, RSTART + 4, RLENGTH - 4) quote substr(line, RSTART + RLENGTH)
}
/^ *\/\/\/ *$/ { blank = 1; print; next }
/^ *\/\/\/   +[^ ]/ && (blank || code) { sub(/\/\/\/ /, "///     "); blank = 0; code = 1; print; next }
{ blank = code = 0 }
!/\/\/\// { print; next }
{ match($0, /\/\/\/<?/); $0 = plain($0, RSTART + RLENGTH) }
/^ *\/\/\/ [A-Z][a-z]+  +[^ ]/ { print label($0, "**"); next }
/^ *\/\/\/ [a-z][a-z0-9_-]+  +[^ ]/ { print label($0, "`"); next }
{ print }
