#!/bin/sh
# Links with another compiler than the project's: link_with.sh COMPILER PROJECT_COMPILER arguments...
compiler=$1
shift 2
exec "$compiler" "$@"
