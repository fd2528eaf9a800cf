// A shared library that no host has.
int gone() {
  return 0;
}
