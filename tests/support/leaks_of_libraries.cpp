// Drivers keep a few blocks until the process ends, and HDF5 loses some when it refuses a damaged file. The leak checker,
// where there is one, asks here what to pass over, in silence; the program's own memory is still checked.
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
