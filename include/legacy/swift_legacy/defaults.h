/* The constants that arguments of SWIFT_Scene have by default, and those that programs give for what they do not ask for. */
#ifndef SWIFT_LEGACY_DEFAULTS_H
#define SWIFT_LEGACY_DEFAULTS_H

#include "../SWIFT_common.h"

const int BOX_SETTING_DEFAULT = 0;
const int BOX_SETTING_CUBE = 1;
const int BOX_SETTING_DYNAMIC = 2;
const int BOX_SETTING_CHOOSE = 3;
const int BOX_SETTING_COPY = 4;

const int SWIFT_VERTEX = 1;
const int SWIFT_EDGE = 2;
const int SWIFT_FACE = 3;

enum SPLIT_TYPE { MEDIAN, MIDPOINT, MEAN, GAP };

namespace swift_legacy {

/* One in a program, whichever files refer to it, as default arguments have to. */
template <class Unused> struct Identity {
    static const SWIFT_Orientation orientation;
    static const SWIFT_Translation translation;
};

template <class Unused> const SWIFT_Orientation Identity<Unused>::orientation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
template <class Unused> const SWIFT_Translation Identity<Unused>::translation = {0, 0, 0};

} // namespace swift_legacy

const bool DEFAULT_BP = true;
const bool DEFAULT_GS = true;
const bool DEFAULT_FIXED = false;
static const SWIFT_Orientation& DEFAULT_ORIENTATION = swift_legacy::Identity<void>::orientation;
static const SWIFT_Translation& DEFAULT_TRANSLATION = swift_legacy::Identity<void>::translation;
const SWIFT_Real DEFAULT_SCALE = 1;
const int DEFAULT_BOX_SETTING = BOX_SETTING_DEFAULT;
const SWIFT_Real DEFAULT_BOX_ENLARGE_REL = 0;
const SWIFT_Real DEFAULT_BOX_ENLARGE_ABS = 0;
const int* const DEFAULT_FACE_VALENCES = NULL; /* all triangles */
const int DEFAULT_COPY = -1;
const int DEFAULT_MIN_TCOUNT = 50;
const SWIFT_Real DEFAULT_QSLIM_TRATIO = static_cast<SWIFT_Real>(0.25);
const SWIFT_Real DEFAULT_CUBE_ASPECT_RATIO = 2;
const SPLIT_TYPE DEFAULT_SPLIT_TYPE = MIDPOINT;

/* For objects of several pieces or levels, and with one S more for those of both. */
const SWIFT_Orientation* const DEFAULT_ORIENTATIONS = NULL;
const SWIFT_Orientation* const* const DEFAULT_ORIENTATIONSS = NULL;
const SWIFT_Translation* const DEFAULT_TRANSLATIONS = NULL;
const SWIFT_Translation* const* const DEFAULT_TRANSLATIONSS = NULL;
const SWIFT_Real* const DEFAULT_SCALES = NULL;
const SWIFT_Real* const* const DEFAULT_SCALESS = NULL;
const int* const DEFAULT_BOX_SETTINGS = NULL;
const SWIFT_Real* const DEFAULT_BOX_ENLARGE_RELS = NULL;
const SWIFT_Real* const DEFAULT_BOX_ENLARGE_ABSS = NULL;
const int* const* const DEFAULT_FACE_VALENCESS = NULL;
const int* const* const* const DEFAULT_FACE_VALENCESSS = NULL;
const int* const DEFAULT_COPIES = NULL;
const int* const DEFAULT_MIN_TCOUNTS = NULL;
const SWIFT_Real* const DEFAULT_QSLIM_TRATIOS = NULL;
const SWIFT_Real* const DEFAULT_CUBE_ASPECT_RATIOS = NULL;

SWIFT_Real** const NO_DISTANCES = NULL;
SWIFT_Real** const NO_NEAREST_PTS = NULL;
SWIFT_Real** const NO_NORMALS = NULL;
int** const NO_PIDS = NULL;
int** const NO_FEAT_TYPES = NULL;
int** const NO_FEAT_IDS = NULL;

#endif
