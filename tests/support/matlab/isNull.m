function null = isNull(pointer)
  null = pointer == 0;
end
