"""Programs for the convertor: public nodes, damaged sources, and flights on NASA's cFE."""
