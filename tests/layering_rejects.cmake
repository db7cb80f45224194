# The wrong twin of layering.cmake: trees with one forbidden include each must be rejected.
cmake_minimum_required(VERSION 3.23)
set(cases
    "sim/a.cpp|#include \"cad/engines.h\""
    "cad/a.cpp|#include \"sim/tracer.h\""
    "src/base/a.h|#include \"optim/problem.h\""
    "src/optim/a.cpp|#include \"design/scene.h\""
    "src/photometry/a.cpp|#include \"sim/tracer.h\""
    "sim/a.cpp|#include \"photometry/lm63.h\""
    "src/rayfiles/a.cpp|#include \"sim/emitter.h\""
    "sim/a.cpp|#include \"rayfiles/ray_file.h\""
    "src/images/a.cpp|#include \"design/target.h\""
    "sim/a.cpp|#include \"images/image_file.h\""
    "src/design/a.cpp|#include \"report/csv.h\""
    "sim/a.cpp|#include <Geom_BSplineCurve.hxx>"
    "sim/a.h|#include <nanoflann.hpp>"
    "sim/a.cpp|#include \"../cad/engines.h\"")
foreach(case IN LISTS cases)
  string(REPLACE "|" ";" parts "${case}")
  list(GET parts 0 path)
  list(GET parts 1 line)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/${path} "${line}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK} -P ${CMAKE_CURRENT_LIST_DIR}/layering.cmake
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    message(SEND_ERROR "not rejected: ${path}: ${line}")
  endif()
endforeach()
