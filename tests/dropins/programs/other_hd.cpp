// A library with the name of libHD.so or of a vendor's driver, but without its functions.
extern "C" int answer_of_other_library() { return 3; }
