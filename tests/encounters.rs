mod dense_search;
