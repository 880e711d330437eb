#!/bin/bash
# Every type and every function that a public header declares at namespace level has a docstring: docstrings.sh SOURCE
# (The one-line operators of geometry.h speak for themselves.)
cd "$1" || exit 1
missing=$(awk '
  FNR == 1 { previous = "" }
  /^(struct|class|enum class|using) [A-Za-z0-9_]+.*[{=]/ && previous !~ /^\/\/\// && previous !~ /^template/ \
    { print FILENAME ":" FNR ": " $0 }
  /^[A-Za-z][A-Za-z0-9_:<>&*, ]* [a-z_0-9]+\(.*$/ && !/^(inline|template|namespace|using|return)/ \
    && previous !~ /^\/\/\// && previous !~ /^template/ && previous !~ /^[A-Za-z].*[,(]$/ { print FILENAME ":" FNR ": " $0 }
  { previous = $0 }' $(find include -name '*.h' | sort))
[ -z "$missing" ] && { echo "every public declaration has its docstring"; exit 0; }
echo "declarations without a docstring:"
echo "$missing"
exit 1
