surface empty() { }
