// Drivers keep a few blocks until the process ends. The leak checker, where there is one, asks this function what to
// pass over; the program's own memory is still checked.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\n"
         "leak:libEGL\n"
         "leak:libgallium\n"
         "leak:swrast_dri.so\n"
         "leak:libLLVM\n";
}
