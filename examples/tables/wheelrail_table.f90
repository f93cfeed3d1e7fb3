! Reads contact tables, `table.wrp` of `wheelrail table`, and looks contact up in them. Fortran 2008.
!
!     type(contact_table) :: table
!     call read_table(table, 'table.wrp')
!     radius = quantity_number(table, 'rolling_radius_mm', 'right')
!     call look_up(table, 2.5d0, values, touches)       ! values(size(table%quantity))
!
! Lengths in mm, angles in rad; see the comments at the head of each table.
module wheelrail_table
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  implicit none
  private
  public :: contact_table, read_table, quantity_number, look_up

  integer, parameter :: dp = kind(1d0), n_coefficients = 9

  type :: table_quantity
    character(len=18) :: name
    character(len=8) :: side            ! wheelset, left, right
    integer :: needs                    ! 0 contact, 1 curvatures, 2 ellipse
    real(dp) :: tolerance, error        ! in the unit of the quantity
  end type

  type :: contact_table
    real(dp) :: from, to, yaw, radius, tolerance
    type(table_quantity), allocatable :: quantity(:)
    integer, allocatable :: flags(:,:)             ! touches, begins, lacks left, lacks right; cell
    real(dp), allocatable :: lateral(:,:)          ! from, to; cell
    real(dp), allocatable :: coefficients(:,:,:)   ! quantity, power, cell
  end type

contains

  subroutine read_table(table, path)
    type(contact_table), intent(out) :: table
    character(len=*), intent(in) :: path
    character(len=8) :: magic, unit
    character(len=3) :: last
    integer :: file, version, comments, n_cells, n_quantities, n_powers, c, q
    real(dp) :: powers(n_coefficients)
    open(newunit=file, file=path, status='old', action='read')
    read(file, '(a8,i4,1x,a8)') magic, version, unit
    if (magic /= 'WRTABLE' .or. version /= 1 .or. unit /= 'mm') error stop 'not version 1 of a table in mm'
    read(file, '(i8)') comments
    do c = 1, comments
      read(file, '()')
    end do
    read(file, '(3i8)') n_cells, n_quantities, n_powers
    if (n_powers /= n_coefficients) error stop 'another number of coefficients'
    read(file, '(2e25.16)') table%from, table%to
    read(file, '(3e25.16)') table%yaw, table%radius, table%tolerance
    allocate(table%quantity(n_quantities), table%flags(4, n_cells), table%lateral(2, n_cells))
    allocate(table%coefficients(n_quantities, n_coefficients, n_cells))
    do q = 1, n_quantities
      associate (quantity => table%quantity(q))
        read(file, '(a18,i2,1x,a8,2e25.16)') quantity%name, quantity%needs, quantity%side, quantity%tolerance, quantity%error
      end associate
    end do
    table%coefficients = ieee_value(0d0, ieee_quiet_nan)
    do c = 1, n_cells
      read(file, '(4i2,2e25.16)') table%flags(:, c), table%lateral(:, c)
      if (c > 1) then
        if (table%lateral(1, c) < table%lateral(2, c - 1)) error stop 'cells out of order'
      end if
      if (table%flags(1, c) == 0) cycle
      do q = 1, n_quantities
        read(file, '(3e25.16)') powers
        if (exists(table, c, q)) table%coefficients(q, :, c) = powers
      end do
    end do
    read(file, '(a3)') last
    if (last /= 'END') error stop 'no END line: the file was cut off'
    close(file)
  end subroutine

  ! Whether a quantity exists over a cell in which both wheels touch.
  logical function exists(table, cell, q)
    type(contact_table), intent(in) :: table
    integer, intent(in) :: cell, q
    integer :: lacks
    select case (table%quantity(q)%side)
    case ('left')
      lacks = table%flags(3, cell)
    case ('right')
      lacks = table%flags(4, cell)
    case default
      lacks = 0
    end select
    exists = table%quantity(q)%needs + lacks <= 2
  end function

  ! The number of a quantity of 'wheelset', 'left' or 'right'; 0 of an unknown one.
  integer function quantity_number(table, name, side)
    type(contact_table), intent(in) :: table
    character(len=*), intent(in) :: name, side
    integer :: q
    quantity_number = 0
    do q = 1, size(table%quantity)
      if (table%quantity(q)%name == name .and. table%quantity(q)%side == side) quantity_number = q
    end do
  end function

  ! All quantities at a lateral displacement, mm; NaN for what does not exist. touches: whether both wheels do.
  subroutine look_up(table, lateral, values, touches)
    type(contact_table), intent(in) :: table
    real(dp), intent(in) :: lateral
    real(dp), intent(out) :: values(:)
    logical, intent(out) :: touches
    integer :: low, high, middle, k
    real(dp) :: t, width
    touches = .false.
    if (.not. (lateral >= table%from .and. lateral <= table%to)) then
      values = ieee_value(0d0, ieee_quiet_nan)
      return
    end if
    low = 1
    high = size(table%lateral, 2)
    do while (low < high)               ! the last cell that begins at or before the displacement
      middle = (low + high + 1) / 2
      if (table%lateral(1, middle) <= lateral) then
        low = middle
      else
        high = middle - 1
      end if
    end do
    width = table%lateral(2, low) - table%lateral(1, low)
    t = 0
    if (width > 0) t = ((lateral - table%lateral(1, low)) - (table%lateral(2, low) - lateral)) / width
    values = table%coefficients(:, n_coefficients, low)
    do k = n_coefficients - 1, 1, -1
      values = values * t + table%coefficients(:, k, low)
    end do
    touches = table%flags(1, low) == 1
  end subroutine

end module
