// What the sanitizers must know of libraries that are opened while the program runs.
//
// The address sanitizer notes the thread-local blocks of such libraries in a list; at the end its leak checker reads it
// from outside and crashes where Mesa's threads have gone in between ("Tracer caught signal 11"). Without the list it
// does not.
// And HDF5 asks for as much memory as a damaged file says, and takes no for an answer.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0:allocator_may_return_null=1"; }

// Drivers keep a few blocks until the process ends, and HDF5 loses some when it refuses a damaged file. The leak
// checker, where there is one, asks here what to pass over, in silence; the program's own memory is still checked.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\n"
         "leak:libEGL\n"
         "leak:libgallium\n"
         "leak:swrast_dri.so\n"
         "leak:libLLVM\n"
         "leak:libhdf5\n";
}
