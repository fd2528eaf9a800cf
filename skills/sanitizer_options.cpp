/// What AddressSanitizer does in the programs of a build that it watches, which
/// nobody gives an environment: nodes start instances with one of their own.
///
/// Fast DDS 2.9.1 frees its statistics with another size than they were made
/// with, which would end a skill in the middle of its farewell.
extern "C" __attribute__((visibility("default"))) const char*
__asan_default_options();

const char* __asan_default_options() {
  return "new_delete_type_mismatch=0";
}
