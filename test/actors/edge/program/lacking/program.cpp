// A program that lacks a library.
int gone();

int main() {
  return gone();
}
