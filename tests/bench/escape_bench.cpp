#include "bench/escape_truth.h"
#include <cstdlib>
int main(int argc, char** argv) {
  hemibake::bake_truths(argc > 1 ? std::atoi(argv[1]) : 96, argc > 2 ? std::atoi(argv[2]) : 32, argc > 3 ? argv[3] : "");
}
