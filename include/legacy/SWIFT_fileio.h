/*
 * Readers of mesh files, chosen by the magic token that a file begins with behind white space: TRI, POLY, OBJ and #OBJ, and those
 * that a program registers.
 */
#ifndef SWIFT_FILEIO_H
#define SWIFT_FILEIO_H

#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "SWIFT_common.h"

/* The headers of old brought them without their namespace, and programs name them so. */
using std::cerr;
using std::cin;
using std::cout;
using std::endl;
using std::ifstream;
using std::ios;
using std::istream;
using std::ofstream;
using std::ostream;

class SWIFT_File_Reader {
public:
    virtual ~SWIFT_File_Reader() {}

    /*
     * Reads a mesh from a stream that stands at the beginning of the file: `vs` 3 * vn coordinates, `fs` the 0-based vertices of fn
     * faces, counter-clockwise from outside, `fv` the number of vertices of each, or NULL when all are triangles. The arrays come
     * from new[]; who called frees them. False refuses the file.
     */
    virtual bool Read(std::ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv) = 0;
};

/*
 * TRI:  TRI nv nf (x y z)*nv (i j k)*nf
 * POLY: POLY nv nf (x y z)*nv (n i1 ... in)*nf
 * Text, separated by white space, without comments. What stands behind is not looked at.
 */
class SWIFT_Basic_File_Reader : public SWIFT_File_Reader {
public:
    virtual bool Read(std::ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv);

    template <class Dispatcher> bool Register_Yourself(Dispatcher& dispatcher)
    {
        return dispatcher.Register("TRI", this) && dispatcher.Register("POLY", this);
    }
};

/* v and f lines, `f a/b/c` forms, 1-based, negative numbers count from the end; the first word is OBJ or #OBJ. */
class SWIFT_Obj_File_Reader : public SWIFT_File_Reader {
public:
    virtual bool Read(std::ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv);

    template <class Dispatcher> bool Register_Yourself(Dispatcher& dispatcher)
    {
        return dispatcher.Register("OBJ", this) && dispatcher.Register("#OBJ", this);
    }
};

class SWIFT_File_Read_Dispatcher {
public:
    /* With the readers for TRI, POLY and OBJ registered. */
    SWIFT_File_Read_Dispatcher();

    /*
     * The reader stays the caller's and is used until it is replaced. A magic that is registered is replaced, with a warning. False
     * where one magic begins with the other, where the magic is empty or has white space, or where there is no reader.
     */
    bool Register(const char* magic_number, SWIFT_File_Reader* file_reader);

    /* As SWIFT_File_Reader::Read, by the reader for the file's magic token. */
    bool Read(const char* filename, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv);

private:
    typedef std::pair<std::string, SWIFT_File_Reader*> Entry;
    SWIFT_Basic_File_Reader basic_;
    SWIFT_Obj_File_Reader obj_;
    std::vector<Entry> entries_;

    SWIFT_File_Read_Dispatcher(const SWIFT_File_Read_Dispatcher&);
    SWIFT_File_Read_Dispatcher& operator=(const SWIFT_File_Read_Dispatcher&);
};

#include "swift_legacy/mesh_files.h"

#endif
