"""III-D, Fig. 9: does it come to rest?"""
