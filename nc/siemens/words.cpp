#include "nc/siemens/words.hpp"

#include <set>

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
  switch (g) {
    case 20:
    case 21:
      return "this control's inch and mm are G70 and G71, or G700 and G710; programs in ISO code begin with G291";
    case 28:
    case 30:
    case 43:
    case 49:
    case 80:
    case 81:
    case 82:
    case 83:
    case 98:
    case 99:
      return "this is a word of ISO code, which this control knows only after G291";
    case 33:
    case 34:
    case 35:
      return "threading is not computed here; write G1 with G95";
    case 96:
    case 961:
      return "constant surface speed is not computed here; write the spindle speeds with G97";
    case 110:
    case 111:
    case 112:
      return "polar coordinates are not computed here; let the post-processor write X, Y, Z";
    case 147:
    case 148:
    case 247:
    case 248:
    case 347:
    case 348:
      return "soft approach and retraction are not computed here; let the post-processor write them out";
    case 291:
      return "a change to ISO code within a program is not followed; write it in the first block";
    default:
      return "its effect on times and speeds is not known here; if it has none, name it under `ignore`";
  }
}

}  // namespace driftwright
