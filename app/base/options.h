// The options of the command line, one struct for all commands; each command reads what it needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

struct Options {
  std::string command;
  std::string word;                           ///< `figure NAME`, `list KIND`
  std::vector<std::string> words;             ///< `validate NAME...`
  std::vector<std::filesystem::path> inputs;  ///< scene, trajectories, or a file to inspect
  std::filesystem::path output;               ///< -o
  std::vector<std::string> set;               ///< --set, in order
  std::optional<double> time;                 ///< --time: a still
  std::optional<std::int64_t> steps;          ///< --steps
  int jobs = 0;                               ///< -j; 0: as in the scene
  std::string gl = "auto";
  std::filesystem::path shader_dir;
  int shard = 0, shards = 1;                             ///< --shard 0/4: frames 0, 4, 8, ...
  std::filesystem::path csv, motion, suspension, pairs;  ///< --csv, ...; "-": standard output
  bool dry_run = false, quiet = false, resume = false, force = false, markdown = false;
  std::filesystem::path vtk, ply;                      ///< --vtk DIR, --ply DIR
  int latitudes = 64;                                  ///< of exported meshes
  std::string preset = "default";                      ///< of `compare`
  std::vector<std::pair<std::string, double>> limits;  ///< its thresholds, as given
  std::vector<std::string> ignore;                     ///< --ignore X,Y,WxH
  std::filesystem::path mask, junit, html, diff;
  bool json = false, update = false;
  std::string vary, values, quantities;  ///< of `converge`, as given
  std::vector<std::string> axes;         ///< --vary KEY=VALUES of `sweep`, in order
  bool quick = false, full = false;      ///< --quick, --full
};

}  // namespace app
