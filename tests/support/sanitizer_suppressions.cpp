// What sanitizers are told not to report. Part of every program of a build with sanitizers.

// CLN, which GiNaC computes with, never frees a string that it makes as it is loaded.
extern "C" const char* __lsan_default_suppressions() { return "leak:libcln\n"; }
// Nor a word about it: tests read what the program says.
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

// Of what a thread did long ago, the stack is to be known still, or the lines below do not see TBB on it.
extern "C" const char* __tsan_default_options() { return "history_size=7"; }
// Debian's oneTBB is built without ThreadSanitizer, which so cannot see how its tasks follow each other. What these
// lines silence has TBB's functions somewhere on the stack: also what code of ours does in TBB's tasks. What refinement
// does by threads of its own (core/team.h) is looked at in full.
extern "C" const char* __tsan_default_suppressions() {
  return "race:^tbb::detail::\nrace:libtbb.so\ncalled_from_lib:libtbb.so\n";
}
