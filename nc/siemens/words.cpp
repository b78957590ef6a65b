#include "nc/siemens/words.hpp"

#include <set>
#include <utility>
#include <vector>

namespace driftwright {

bool is_siemens_keyword_without_effect(const std::string& name) {
  static const std::set<std::string> kWords = {
      "SOFT",   "BRISK",    "DRIVE",     "SOFTA",    "BRISKA",   "FFWON",   "FFWOF",     "COMPCAD", "COMPON",
      "COMPOF", "COMPCURV", "COMPSURF",  "CUT2D",    "CUT2DF",   "NORM",    "KONT",      "KONTC",   "KONTT",
      "CFC",    "CFTCP",    "CFIN",      "DIAMOF",   "RTLION",   "RTLIOF",  "STOPRE",    "WALIMON", "WALIMOF",
      "ORIWKS", "ORIMKS",   "STARTFIFO", "STOPFIFO", "FIFOCTRL", "UPATH",   "SPATH",     "SAVE",    "DISPLOF",
      "SPCON",  "SPCOF",    "CPRECON",   "CPRECOF",  "G60",      "TRAFOOF", "EXTCALLOFF"};
  return kWords.contains(name);
}

bool is_siemens_call_without_effect(const std::string& name) {
  static const std::set<std::string> kCalls = {"MSG",       "SETAL",  "WORKPIECE", "CYCLE832", "GROUP_BEGIN",
                                               "GROUP_END", "FGROUP", "SETMS",     "STOPRE"};
  return kCalls.contains(name);
}

bool is_siemens_g_without_effect(int g) {
  static const std::set<int> kCodes = {9,   60,  64,  601, 602, 603, 641, 642, 643, 644, 645,
                                       450, 451, 460, 461, 462, 621, 622, 97,  25,  26};
  return kCodes.contains(g);
}

const char* siemens_g_hint(int g) {
  static const std::vector<std::pair<std::set<int>, const char*>> kHints = {
      {{20, 21}, "this control's inch and mm are G70 and G71, or G700 and G710; programs in ISO code begin with G291"},
      {{28, 30, 43, 49, 80, 81, 82, 83, 98, 99}, "this is a word of ISO code, which this control knows only after G291"},
      {{33, 34, 35}, "threading is not computed here; write G1 with G95"},
      {{96, 961}, "constant surface speed is not computed here; write the spindle speeds with G97"},
      {{110, 111, 112}, "polar coordinates are not computed here; let the post-processor write X, Y, Z"},
      {{147, 148, 247, 248, 347, 348},
       "soft approach and retraction are not computed here; let the post-processor write them out"},
      {{291}, "a change to ISO code within a program is not followed; write it in the first block"}};
  for (const auto& [codes, hint] : kHints) {
    if (codes.contains(g)) return hint;
  }
  return "its effect on times and speeds is not known here; if it has none, name it under `ignore`";
}

}  // namespace driftwright
