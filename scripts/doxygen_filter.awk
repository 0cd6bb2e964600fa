# Makes the project's comments documentation for Doxygen (docs/Doxyfile, INPUT_FILTER); line numbers stay.
#   awk -f scripts/doxygen_filter.awk HEADER.h
# `//` lines before a declaration document it; `// ...` behind one, and the lines that go on below it, document that
# one; those above `#pragma once` the file. Comments inside the bodies of functions stay comments.

# Everything means itself, but for what stands between back quotes, which is code.
function plain(text,    parts, n, i, out, lead) {
  lead = ""
  if (match(text, /^ +/)) { lead = substr(text, 1, RLENGTH); text = substr(text, RLENGTH + 1) }
  # Tables and lists that are laid out by spaces keep their lines; what is indented further goes on.
  if ((length(lead) >= 2 && length(lead) < 9) || (length(lead) < 2 && text ~ /[^ .]   +[^ ]/)) text = "@BR@" text
  n = split(text, parts, "`")
  out = ""
  for (i = 1; i <= n; i++) {
    if (i % 2 == 1 || i == n) {
      gsub(/[\\@<>#%&*]/, "\\\\&", parts[i])
      sub(/^\\@BR\\@/, "<br>", parts[i])
      # a number, a dash or a plus that begins a line is no list
      if (i == 1 && parts[i] ~ /^([0-9]+\.|[-+]) /) sub(/^/, "\\&#8203;", parts[i])
    }
    out = out (i > 1 ? "`" : "") parts[i]
  }
  return " " out
}
function indent(line) { match(line, /^ */); return RLENGTH }

{ line = $0 }
line ~ /^ *\/\/ (clang-format|NOLINT)/ { print ""; next }
line ~ /^#pragma once/ { print "/// @file"; next }

# A line that is a comment.
line ~ /^ *\/\// {
  text = line
  sub(/^ *\/\//, "", text)
  if (body > 0) print line
  else if (behind && indent(line) > column_of_code + 1) print substr(line, 1, indent(line)) "///<" plain(text)
  else { print substr(line, 1, indent(line)) "///" plain(text); behind = 0 }
  next
}

{
  behind = 0
  code = line
  comment = ""
  at = match(line, /[^ ] +\/\/ /)
  if (at && line !~ /"[^"]*\/\/[^"]*"/) {
    rest = substr(line, at + 1)
    sub(/^ +\/\//, "", rest)
    code = substr(line, 1, at)
    comment = rest
  }
  # Bodies: what is between braces that follow a parameter list, `const`, `override`, `noexcept`.
  opens = gsub(/{/, "{", code)
  closes = gsub(/}/, "}", code)
  if (body > 0 || (code ~ /\)( const)?( noexcept)?( override)?( :.*)? *{/ && code !~ /^ *(class|struct|enum|namespace)/)) {
    body += opens - closes
    if (body < 0) body = 0
    print line
    next
  }
  if (comment != "" && code !~ /[{}]$/ && code !~ /^#/) {
    print code "  ///<" plain(comment)
    behind = 1
    column_of_code = indent(line)
    next
  }
  if (comment != "" && code ~ /{}$|};$/) { print code "  ///<" plain(comment); behind = 1; column_of_code = indent(line); next }
  print line
}
