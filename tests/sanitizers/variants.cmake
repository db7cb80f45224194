# Every room once more, as object files made under address and undefined-behaviour sanitizers (asan) and, of those that
# start threads or run in them, under the thread sanitizer (tsan), in the same build: so that the tests, which need not
# be watched themselves, are compiled once. Objects come first on the command line that links them, and with them the
# templates and inline functions that they and the tests both have.

# Compiling costs most of the time that sanitizers take: half of it is saved by units of many files. -O1: the code that is
# watched must still trace a million rays. Reports name functions; lines (-g1) take an eighth of the compile time, and only
# tsan needs them, to know files. Warnings are the other build's business: GCC 12 raises false alarms in instrumented code.
set(CATOPTRIC_WATCHED -O1 -w -fno-omit-frame-pointer -fno-sanitize-recover=all)
add_library(catoptric_flags_asan INTERFACE)
# GCC leaves float-cast-overflow out: infinity made an integer. What is left out here costs a third of the compile time,
# and address sanitizer or the processor stops at what it would find.
target_compile_options(catoptric_flags_asan INTERFACE -fsanitize=address,undefined -fsanitize=float-cast-overflow
                       -fno-sanitize=null,alignment,vptr,object-size ${CATOPTRIC_WATCHED})
# Else Eigen aligns by hand under asan, and frees so what libraries that are not instrumented (pagmo2) allocated.
target_compile_definitions(catoptric_flags_asan INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1 _GLIBCXX_ASSERTIONS
                           CATOPTRIC_CONTRACTS)
target_link_options(catoptric_flags_asan INTERFACE -fsanitize=address,undefined)
add_library(catoptric_flags_tsan INTERFACE)
target_compile_options(catoptric_flags_tsan INTERFACE -fsanitize=thread -g1 ${CATOPTRIC_WATCHED})
target_link_options(catoptric_flags_tsan INTERFACE -fsanitize=thread)
set(CATOPTRIC_ROOMS_WITH_THREADS base cluster optim sim)
# Compiling report and cli once more takes the landing run two minutes: tests/sanitizers/run.sh adds them.
set(CATOPTRIC_SANITIZED_ROOMS base cluster cad sim optim photometry rayfiles images design CACHE STRING
    "Rooms that are built and tested under sanitizers as well")

# catoptric_<room>_<variant>: the objects; catoptric_<room>_<variant>_needs: what they are linked with.
function(catoptric_add_sanitized_rooms room)
  if(NOT room IN_LIST CATOPTRIC_SANITIZED_ROOMS)
    return()
  endif()
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;INCLUDES" ${ARGN})
  foreach(variant asan tsan)
    if(variant STREQUAL "tsan" AND NOT room IN_LIST CATOPTRIC_ROOMS_WITH_THREADS)
      continue()
    endif()
    set(needs ${ROOM_LINK})
    list(TRANSFORM needs REPLACE "^catoptric::(.*)$" "catoptric_\\1_${variant}_needs")
    set(below ${ROOM_LINK})
    list(FILTER below INCLUDE REGEX "^catoptric::")
    list(TRANSFORM below REPLACE "^catoptric::" "")
    set(objects $<TARGET_OBJECTS:catoptric_${room}_${variant}>)
    foreach(each ${below})
      get_property(others GLOBAL PROPERTY catoptric_${each}_${variant}_objects)
      list(APPEND objects ${others})
    endforeach()
    list(REMOVE_DUPLICATES objects)
    set_property(GLOBAL PROPERTY catoptric_${room}_${variant}_objects ${objects})

    add_library(catoptric_${room}_${variant}_needs INTERFACE)
    target_link_libraries(catoptric_${room}_${variant}_needs INTERFACE ${needs})
    add_library(catoptric_${room}_${variant} OBJECT ${ROOM_SOURCES})
    target_include_directories(catoptric_${room}_${variant} PRIVATE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/src)
    target_include_directories(catoptric_${room}_${variant} SYSTEM PRIVATE ${ROOM_INCLUDES})
    target_link_libraries(catoptric_${room}_${variant} PRIVATE catoptric_flags catoptric_flags_${variant} ${needs})
    if(room MATCHES "^(design|report)$")  # no rays there
      target_compile_options(catoptric_${room}_${variant} PRIVATE -O0)
    endif()
    set_target_properties(catoptric_${room}_${variant} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 24)
  endforeach()
endfunction()

# A program of the given sources with the objects of the given rooms and of those below them.
function(catoptric_add_sanitized_program name variant rooms)
  set(objects "")
  set(needs "")
  foreach(room ${rooms})
    get_property(below GLOBAL PROPERTY catoptric_${room}_${variant}_objects)
    list(APPEND objects ${below})
    list(APPEND needs catoptric_${room}_${variant}_needs)
  endforeach()
  list(REMOVE_DUPLICATES objects)
  add_executable(${name} ${objects} ${CMAKE_SOURCE_DIR}/tests/sanitizers/options.cpp ${ARGN})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(${name} PRIVATE catoptric_flags catoptric_flags_${variant} ${needs})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX UNITY_BUILD ON)
endfunction()

# The tests of a room, compiled already, on watched rooms. Cases tagged [long] (more than 5 s here, of which many
# repetitions are the point) are left to tests/sanitizers/run.sh; what [unsanitized] is says why.
function(catoptric_add_sanitized_tests room)
  if(NOT room IN_LIST CATOPTRIC_SANITIZED_ROOMS)
    return()
  endif()
  if(room STREQUAL "cli")  # of this the program is to be watched
    add_dependencies(test_cli catoptric_asan)
    catch_discover_tests(test_cli TEST_SPEC "~[long]~[unsanitized]~[.]" TEST_PREFIX "asan: cli: " TEST_LIST sanitized_cli
      PROPERTIES TIMEOUT 600 ENVIRONMENT "CATOPTRIC_PROGRAM=$<TARGET_FILE:catoptric_asan>")
    return()
  endif()
  set(rooms ${ARGN})
  list(FILTER rooms INCLUDE REGEX "^catoptric::")
  list(TRANSFORM rooms REPLACE "^catoptric::" "")
  set(libraries ${ARGN})
  list(FILTER libraries EXCLUDE REGEX "^catoptric::")
  catoptric_add_sanitized_program(test_${room}_asan asan "${rooms}" $<TARGET_OBJECTS:test_${room}_objects>)
  target_link_libraries(test_${room}_asan PRIVATE Catch2::Catch2WithMain ${libraries})
  catch_discover_tests(test_${room}_asan TEST_SPEC "~[long]~[unsanitized]~[.]" TEST_PREFIX "asan: ${room}: " EXTRA_ARGS --warn NoTests
                       PROPERTIES TIMEOUT 600)
  if(room MATCHES "^(sim|optim|cluster)$")  # in one process, which so counts its statistical checks as well
    catoptric_add_sanitized_program(test_${room}_tsan tsan ${room} $<TARGET_OBJECTS:test_${room}_objects>)
    # What Catch2 needs of the standard library comes from there: the rooms' archives have copies of its templates, and
    # one that is taken for such a copy brings all its functions a second time.
    target_link_libraries(test_${room}_tsan PRIVATE Catch2::Catch2WithMain stdc++ ${ARGN})
    # Of sim what lets threads work side by side: the rest would only be slow.
    set(cases "~[long]~[unsanitized]~[.]")
    if(room STREQUAL "sim")
      string(PREPEND cases "[threads]")
    endif()
    add_test(NAME "tsan: ${room}" COMMAND test_${room}_tsan ${cases} --warn NoTests)
    set_tests_properties("tsan: ${room}" PROPERTIES TIMEOUT 600 COST 100)  # the longest of all first
  endif()
endfunction()
