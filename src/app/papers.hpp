#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vigia/evaluation/paper_table.hpp"

namespace vigia::app {

/// How a paper's experiment is to be repeated.
struct PaperOptions {
  std::filesystem::path config;  ///< the folder with missions/, worlds/, robots/
  std::filesystem::path out;     ///< where pictures go; the command writes the table itself
  int seeds = 0;                 ///< drives or trials; 0: the experiment's own number
  int threads = 1;
  bool quiet = false;
};

/// A paper whose experiment the program repeats. Wrong input throws InputError.
struct Paper {
  std::string name;   ///< as on the command line
  std::string title;  ///< of the experiment, one line
  evaluation::PaperTable (*repeat)(const PaperOptions& options);
};

/// Every paper of `vigia reproduce`.
const std::vector<Paper>& papers();

// The experiments, each in a file of its own, reproduce_<name>.cpp.
evaluation::PaperTable reproduce_armingol(const PaperOptions& options);
evaluation::PaperTable reproduce_bais(const PaperOptions& options);
evaluation::PaperTable reproduce_chonbuk(const PaperOptions& options);
evaluation::PaperTable reproduce_minho(const PaperOptions& options);
evaluation::PaperTable reproduce_quixote(const PaperOptions& options);

}  // namespace vigia::app
