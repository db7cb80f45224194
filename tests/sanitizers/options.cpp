// What every sanitized program asks of its sanitizers, so that it need not be told by whoever starts it.

// The sanitizer's own report, with a stack; a process that is to die of a signal may still ask for that.
extern "C" const char* __asan_default_options() {
  return "handle_segv=1:handle_sigfpe=1:malloc_context_size=4:quarantine_size_mb=32";
}

extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1"; }

// With a shorter history a long run forgets who touched a place before. What is left out below is then not
// recognised, and one run of many fails (seen on a machine with much other work).
extern "C" const char* __tsan_default_options() { return "history_size=7"; }

// Debian's libtbb is not instrumented: it hands tasks from thread to thread by means the sanitizer cannot
// see, so that the fields of its own tasks look shared, and so do the references that side_by_side() gives to
// a task. Only these are left out: by the file that touches them (race_top: deeper frames do not count), and
// atomics by the functions that touch them, which call nothing of ours. The bodies of our loops stay watched
// (test "a race is found"); what is ordered before and after a loop is told in sim/side_by_side.cpp, not
// suppressed.
extern "C" const char* __tsan_default_suppressions() {
  return "race_top:/oneapi/tbb/\n"
         "race:tbb::detail::d1::node::node\n"
         "race:tbb::detail::d1::tree_node::tree_node\n"
         "race:fold_tree\n"
         "race:check_being_stolen\n"
         "race:task_group_context::is_proxy\n"
         "race_top:/sim/side_by_side.cpp\n";
}
