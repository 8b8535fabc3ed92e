"""How wrong a curve of a balance is, estimated by its embedded pair, and as many harmonics as an accuracy
takes."""
